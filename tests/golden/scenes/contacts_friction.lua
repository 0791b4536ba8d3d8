-- Friction: boxes and balls on a tilted plane, with rolling, spinning and directional friction.
--@ ticks 120
sim:add_body("ramp"):add_part("ramp", sim:add_plane_shape("ramp", vec3(0.3, 0.1, 1)))
local box = sim:add_box_shape("box", vec3(0.2, 0.15, 0.1))
local ball = sim:add_sphere_shape("ball", 0.1)
local wheel = sim:add_cylinder_shape("wheel", 0.1, 0.06)
for i = 0, 5 do
  local up = -0.3 * i - 0.1 * i
  sim:add_body("box" .. i):add_part("p", box, { position = vec3(i, i, up + 0.14), friction = 0.2 * i })
  sim:add_body("directed" .. i):add_part("p", box, {
    position = vec3(i, i + 0.5, up + 0.1), friction = 0.5, friction_direction = vec3(1, 0.2 * i, 0), friction_factor = 0.3 * i,
    linear_velocity = vec3(0, 1, 0),
  })
  sim:add_body("ball" .. i):add_part("p", ball, {
    position = vec3(i, i - 0.5, up + 0.17), friction = 1, rolling_friction = 0.005 * i, spinning_friction = 0.01 * i,
    angular_velocity = vec3(0, 0, 20),
  })
  sim:add_body("wheel" .. i):add_part("p", wheel, {
    position = vec3(i, i + 0.25, up + 0.3), rotation = quat.euler(math.pi / 2, 0, 0.2 * i), friction = 0.8,
  })
end
