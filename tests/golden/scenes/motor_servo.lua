-- Servos: a target each tick, irregular targets that are smoothed, limits of speed and force.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })

local motors = arm.motors
for i, m in ipairs(motors) do
  if i % 2 == 0 then m.target_smoothing = 0.05 end
  m.speed = 1 + i
end
motors[3].max_angular_force = 8
motors[6].bounce = 0.5
sim:on_step(function() motors[1].target = 0.5 * sim.time * sim.time end)
sim:every(0.07, function()
  for i = 2, 6 do motors[i].target = rng:uniform(-1, 1) end
end)
