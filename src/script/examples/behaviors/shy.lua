-- Uses the group type shy of behaviors_lua/shy.lua.
sim.gravity = vec3()
local shape = sim:add_sphere_shape("ball", 0.05)
for i = 1, 8 do sim:add_body("ball" .. i):add_part("ball", shape, { position = vec3(i * 0.12, 0, 1) }) end
sim:add_group_behavior("shy", "distance", { bodies = "ball*", push = 4 })
sim:after(2, function()
  print(sim:body("ball8").position.x - sim:body("ball1").position.x > 7 * 0.12) --> true
end)
