-- Sleep: stacks and an arm come to rest, and are woken by an impact, by a property and by a body that arrives.
--@ ticks 240
--@ 150 send /physics/part/friction box3 0.1
--@ 180 send /physics/sim/gravity 0 0.5 -9
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local box = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
for i = 0, 3 do sim:add_body("box" .. i):add_part("p", box, { position = vec3(0.5 * (i % 2), 0, 0.1 + 0.2 * math.floor(i / 2)) }) end
sim:load_urdf("urdf/arm6.urdf", { name = "arm", position = vec3(2, 0, 0) })
local awake = sim:add_body("awake", { can_sleep = false })
awake:add_part("p", box, { position = vec3(-2, 0, 0.1) })
sim:at(1.8, function()
  sim:body("box2").root:apply_impulse(vec3(0.4, 0.1, 0))
  sim:add_body("visitor"):add_part("p", box, { position = vec3(0.5, 0.1, 1) })
end)
