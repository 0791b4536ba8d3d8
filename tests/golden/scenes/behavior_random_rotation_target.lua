-- The built-in behavior random_rotation_target: servos with random targets.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
for motor in arm:motors() do motor.max_angular_force = 30 end

arm:add_behavior("random_rotation_target", "fidget",
  { min_target = vec3(0, 0, -1.2), max_target = vec3(0, 0, 1.2), speed = 0.3, rand_interval = 300 })
