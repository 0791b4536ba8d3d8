-- The Lua versions of the built-in behaviors that move servos and springs.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
for motor in arm:motors() do motor.max_angular_force = 30 end
arm:add_behavior("lua_rotation_target", "reach", { joints = "joint_[1-3]", target = vec3(0, 0, 1.1), speed = 0.05 })
arm:add_behavior("lua_random_rotation_target", "fidget",
  { joints = "joint_[4-6]", min_target = vec3(0, 0, -1.2), max_target = vec3(0, 0, 1.2), speed = 0.3, rand_interval = 300 })
