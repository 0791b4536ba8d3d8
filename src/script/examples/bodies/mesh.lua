-- A pyramid from five points, and a hull of a mesh file at half its size.
local pyramid = sim:add_convex_mesh_shape("pyramid", {
  vec3(-0.2, -0.2, 0), vec3(0.2, -0.2, 0), vec3(0.2, 0.2, 0), vec3(-0.2, 0.2, 0), vec3(0, 0, 0.3),
})
local hull = sim:add_convex_mesh_shape("hull", "urdf/meshes/finger.stl", { scale = 0.5, max_vertices = 32 })
sim:add_body("pyramid"):add_part("part", pyramid)
sim:add_body("hull"):add_part("part", hull, { position = vec3(1, 0, 0) })
print(pyramid.name, #sim.bodies) --> pyramid 2
