-- Undo and redo of values, resets of the scene and of bodies, while everything moves.
--@ ticks 150
--@ 10 send /physics/sim/gravity 0 0 -2
--@ 20 send /physics/part/mass box2 4
--@ 30 send /edit/undo
--@ 35 send /edit/undo
--@ 40 send /edit/redo
--@ 60 send /transport/reset
--@ 90 send /push 1 3
--@ 110 eval sim:body("box3"):reset()
--@ 120 send /physics/body/box4/enabled 0
--@ 135 send /physics/body/box4/enabled 1
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
