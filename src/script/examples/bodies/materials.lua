-- Drops a rubber ball and a sticky box on the floor.
local floor = sim:add_body("floor")
floor:add_part("floor", sim:add_plane_shape("floor"), { friction = 1, restitution = 1 })
local things = sim:add_body("things", { self_collision = false })
local ball = things:add_part("ball", sim:add_sphere_shape("ball", 0.1), {
  mass = 0.2, restitution = 0.8, rolling_friction = 0.01, linear_damping = 0.05, position = vec3(0, 0, 1),
})
local box = things:add_part("box", sim:add_box_shape("box", vec3(0.2, 0.2, 0.2)), {
  mass = 1, friction = 0.9, angular_damping = 0.2, position = vec3(0.5, 0, 0.11), linear_velocity = vec3(1, 0, 0),
})
sim:after(2, function()
  print(ball.position.z > 0.1, box.linear_velocity:length() < 0.01) --> true true
  print(ball.mass, string.format("%.4f", ball.inertia.x), box.center.z < 0.2) --> 0.2 0.0008 true
end)
