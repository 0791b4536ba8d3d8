-- The built-in behavior rotation_target_oscil: servos that go back and forth between two targets.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
for motor in arm:motors() do motor.max_angular_force = 30 end

arm:add_behavior("rotation_target_oscil", "swing",
  { target1 = vec3(0, 0, -0.6), target2 = vec3(0, 0, 0.9), speed = 0.3, oscil_interval = 350 })
