-- The built-in group behavior cohesion on sixteen balls, one of which leaves the group.
--@ ticks 120
sim.gravity = vec3(0, 0, 0)
local ball = sim:add_sphere_shape("ball", 0.05)
for i = 1, 16 do
  local body = sim:add_body("ball" .. i)
  body:add_part("p", ball, {
    mass = 0.1, position = rng:uniform(vec3(-1, -1, 0), vec3(1, 1, 1)), linear_velocity = rng:direction() * 0.5,
    angular_velocity = rng:direction() * 3,
  })
end
local group = sim:add_group_behavior("cohesion", "group", { bodies = "ball*", min_dist = 0.1, max_dist = 1.2, amount = 0.3 })
sim:at(0.5, function() sim:body("ball3"):remove() end)
sim:at(1, function() group.amount = group.amount * 2 end)
sim:at(1.5, function() sim:body("ball5"):behavior("group").active = false end)
