-- Collision groups and masks, excluded and included pairs, self-collision, changed while the scene plays.
--@ ticks 120
--@ 40 send /physics/part/collisionmask ball2 1
--@ 70 send /physics/body/pair/self_collision false
sim.collision_groups = { "default", "ghost", "marker" }
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local ball = sim:add_sphere_shape("ball", 0.1)
for i = 1, 6 do
  local body = sim:add_body("ball" .. i)
  body:add_part("p", ball, { position = vec3(0.03 * i, 0.02 * i, 0.1 + 0.21 * i) })
  body.root.collision_group = i % 2 == 0 and "ghost" or { "default", "marker" }
  body.root.collision_mask = i % 3 == 0 and { "default", "marker" } or 65535
end
local pair = sim:add_body("pair")
for i = 1, 4 do pair:add_part("p" .. i, ball, { position = vec3(2 + 0.12 * i, 0, 0.5 + 0.05 * i) }) end
pair:include_pair("p1", "p2")
pair:exclude_pair("p3", "p4")
