-- One body of each simple shape. A capsule's height is that of its cylinder, without the caps.
local shapes = {
  sim:add_sphere_shape("sphere", 0.2),
  sim:add_box_shape("box", vec3(0.3, 0.3, 0.4)),
  sim:add_ellipsoid_shape("ellipsoid", vec3(0.2, 0.15, 0.1)),
  sim:add_cylinder_shape("cylinder", 0.15, 0.4),
  sim:add_capsule_shape("capsule", 0.1, 0.3),
  sim:add_cone_shape("cone", 0.2, 0.4),
}
for i, shape in ipairs(shapes) do
  sim:add_body(shape.name):add_part("part", shape, { position = vec3(i * 0.6, 0, 1) })
end
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor", vec3(0, 0, 1)))
print(sim:body("capsule").root.shape.name) --> capsule
