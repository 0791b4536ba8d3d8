-- The built-in behavior random_torque: random torques several times a second.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
for motor in arm:motors() do motor.max_angular_force = 30 end

arm:add_behavior("random_torque", "shiver", { scale = 2.5, rand_interval = 90, app_interval = 30 })
