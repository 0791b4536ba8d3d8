-- Motors that spin, some against their limits, some too weak.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })

for i, m in ipairs(arm.motors) do
  m.mode, m.speed = "spin", (i % 2 == 0 and 1 or -1) * (0.5 + i)
  m.max_angular_force = i == 4 and 1 or 60
  m.bounce = 0.1 * i
end
sim:at(1, function() for m in arm:motors() do m.speed = -m.speed end end)
