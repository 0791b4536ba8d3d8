-- Scripts that fail: writes and random draws of a failing callback are rolled back, a failing behavior is disabled.
--@ ticks 90
--@ faults 2
--@ 20 send /bad 3
--@ 40 send /bad 5
local ball = sim:add_sphere_shape("ball", 0.1)
sim.gravity = vec3(0, 0, -1)
for i = 1, 3 do sim:add_body("ball" .. i):add_part("p", ball, { position = vec3(i, 0, 2) }) end
osc:on("/bad", function(x)
  sim.gravity = vec3(x, 0, 0)
  sim:body("ball2"):remove()
  sim:body("ball1").root:apply_impulse(rng:direction())
  error("not meant")
end)
local n = 0
sim:every(0.25, function()
  sim:body("ball3").root:apply_impulse(rng:direction() * 0.1)
  n = n + 1
  if n % 2 == 0 then sim.gravity.x = sim.nothing end
end)
