-- Contacts of each pair of shapes, in the iterative solver: each shape falls on the floor and on each other one.
--@ ticks 70
sim.solver = "iterative"
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local box = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
local ball = sim:add_sphere_shape("ball", 0.1)
local corners = {}
for x = -1, 1, 2 do
  for y = -1, 1, 2 do
    for z = -1, 1, 2 do corners[#corners + 1] = vec3(0.12 * x, 0.1 * y, 0.08 * z + 0.02 * x) end
  end
end
local shapes = {
  ball, box, sim:add_cylinder_shape("cylinder", 0.1, 0.2), sim:add_capsule_shape("capsule", 0.08, 0.2),
  sim:add_cone_shape("cone", 0.12, 0.25), sim:add_convex_mesh_shape("hull", corners),
  sim:add_compound_shape("compound"):add_child(ball, vec3(0.1, 0, 0)):add_child(box, vec3(-0.1, 0, 0), quat.euler(0.3, 0.2, 0.1)),
}
for i, falling in ipairs(shapes) do
  for j, standing in ipairs(shapes) do
    local pair = sim:add_body(("pair_%d_%d"):format(i, j))
    local place = vec3(i, j, 0.2)
    pair:add_part("standing", standing, { mass = (i + j) % 2, position = place })
    pair:add_part("falling", falling, {
      position = place + vec3(0.02, 0.01, 0.32), rotation = quat.euler(0.1, 0.2, 0.3), mass = 1, friction = 0.6,
      rolling_friction = 0.01, restitution = 0.3, angular_velocity = vec3(1, 2, 3),
    })
  end
end
