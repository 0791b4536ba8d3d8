-- Motors that are off, with damping, on an arm that falls; modes that change while the scene plays.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })

for i, m in ipairs(arm.motors) do m.mode, m.damping = "off", 0.05 * i end
arm.joints[2].angular_upper_limit = 0.6
sim:at(0.6, function() for m in arm:motors() do m.mode = "servo" end end)
sim:at(1, function() for m in arm:motors() do m.mode = "spin"; m.speed = 1 end end)
sim:at(1.4, function() for m in arm:motors() do m.mode = "off" end end)
