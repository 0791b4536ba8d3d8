-- Lines of a console: statements, calls, errors without an effect.
--@ ticks 90
--@ take
--@ 10 eval sim:body("box1").root:apply_impulse(vec3(1, 0, 0))
--@ 20 eval for b in sim:bodies("box*") do b.root.mass = 0.5 end
--@ 30 eval sim.gravity = vec3(0, 0, 5); error("not meant")
--@ 40 eval rng:uniform()
--@ 50 eval sim:body("box2").root:apply_impulse(rng:direction())
--@ 60 eval sim:body("box9")
local box = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
for i = 1, 5 do sim:add_body("box" .. i):add_part("p", box, { position = vec3(0.25 * i, 0, 0.1 + 0.3 * i) }) end
state.pushes = 0
osc:on("/push", function(x, which)
  state.pushes = state.pushes + 1
  sim:body("box" .. (which or 1)).root:apply_impulse(vec3(x, rng:uniform(-0.01, 0.01), state.pushes % 10 * 0.001))
  osc:reply("/pushed", state.pushes)
end)
osc:on("/lift/*", function(z) for body in sim:bodies("box*") do body.root:apply_impulse(vec3(0, 0, z)) end end)
