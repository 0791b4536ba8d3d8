-- A flood of messages: more than the budget of a tick, so that the rest waits in order.
--@ ticks 90
--@ take
--@ 5 flood 9000 /push 0.0001 1
--@ 6 flood 3000 /physics/part/mass box2 0.5
--@ 7 send /push 1 2
--@ 30 flood 2000 /lift/all 0.001
--@ 60 flood 5000 /push -0.0002 3
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
