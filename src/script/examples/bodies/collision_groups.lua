-- Balls collide with the floor, but not with each other.
sim.collision_groups = { "floor", "balls" } -- names of the first two bits: 1 and 2
local floor = sim:add_body("floor")
floor:add_part("floor", sim:add_plane_shape("floor"), { collision_group = 1 })
for i = 1, 2 do
  local ball = sim:add_body("ball" .. i)
  ball:add_part("ball", sim:add_sphere_shape("ball" .. i, 0.1), {
    collision_group = 2, collision_mask = 1, position = vec3(0, 0, i * 0.5),
  })
end
sim:after(2, function()
  local low, high = sim:body("ball1").position.z, sim:body("ball2").position.z
  print(string.format("%.2f %.2f", low, high)) --> 0.10 0.10
end)
