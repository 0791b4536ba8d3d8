-- Meshes: hulls of mesh files, scaled and simplified, and a compound of hulls, which fall on each other.
--@ ticks 90
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local shapes = {}
for i, name in ipairs { "block", "plate", "link_short", "segment", "base", "tip" } do
  shapes[i] = sim:add_convex_mesh_shape(name, "urdf/meshes/" .. name .. ".stl", { scale = 0.5 + 0.2 * i, max_vertices = 8 * i })
end
local both = sim:add_compound_shape("both"):add_child(shapes[1], vec3(0.2, 0, 0)):add_child(shapes[2], vec3(-0.1, 0, 0), quat.euler(1, 0, 0.5))
shapes[#shapes + 1] = both
for i = 0, 13 do
  sim:add_body("stone" .. i):add_part("p", shapes[i % #shapes + 1], {
    position = vec3(0.3 * (i % 3), 0.3 * (i % 2), 0.3 + 0.25 * i), rotation = quat.euler(0.3 * i, 0.2 * i, 0.1 * i), mass = 1 + i % 3,
  })
end
