-- OSC: the scene's handlers, properties by arguments, paths and patterns, scheduled by tick.
--@ ticks 120
--@ 10 send /push 0.5 2
--@ 20 send /lift/all 1.5
--@ 25 send /physics/part/mass box3 0.3
--@ 30 send /physics/body/box[1-2]/part/*/friction 0.05
--@ 40 send /physics/sim/gravity 1 0 -8
--@ 50 send /physics/part/force box1 p 0 0 200
--@ 51 send /physics/part/impulse box2 p 0 1 0
--@ 60 send /physics/part/hold box4 p 0 0 0 1 0 2
--@ 90 send /physics/body/box5/position 0 0 4
--@ 95 send /push 1 5
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
