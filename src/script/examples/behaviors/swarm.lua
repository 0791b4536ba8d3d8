-- Twelve balls that keep together. A value set on the group is set on every member.
sim.gravity = vec3()
local shape = sim:add_sphere_shape("ball", 0.05)
for i = 1, 12 do
  sim:add_body("ball" .. i):add_part("ball", shape, { position = rng:uniform(vec3(-1, -1, 0), vec3(1, 1, 2)) })
end
sim:add_group_behavior("cohesion", "together", { bodies = "ball*", amount = 0.2 })
sim:add_group_behavior("separation", "apart", { bodies = "ball*" })
sim:after(1, function()
  local group = sim:group_behavior("together")
  group.amount = 0.5
  print(group.type, group.active, sim:body("ball3"):behavior("together").amount) --> cohesion true 0.5
  sim:group_behavior("apart"):remove()
end)
