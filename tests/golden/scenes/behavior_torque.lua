-- The built-in behavior torque: a torque on all parts, and one that is scaled while the scene plays.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
for motor in arm:motors() do motor.max_angular_force = 30 end

arm:add_behavior("torque", "turn", { torque = vec3(0.3, 0.1, 0.7), scale = 2 })
sim:at(1, function() arm:behavior("turn").scale = -1.5 end)
