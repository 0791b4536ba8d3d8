-- A conveyor belt takes a box along, and a box without weight floats above it.
sim.gravity = vec3(0, 0, -9.81)
local belt_shape = sim:add_box_shape("belt", vec3(4, 1, 0.1))
sim:add_body("belt"):add_part("belt", belt_shape, { mass = 0, surface_velocity = vec3(0.5, 0, 0) })
local crate = sim:add_box_shape("crate", vec3(0.2, 0.2, 0.2))
local box = sim:add_body("box"):add_part("box", crate, { position = vec3(-1, 0, 0.15) })
local floating = sim:add_body("floating", { gravity_factor = 0 })
floating:add_part("box", crate, { position = vec3(0, 0, 1) })
sim:after(2, function()
  print(string.format("%.2f m/s", box.linear_velocity.x)) --> 0.50 m/s
  print(floating.position) --> vec3(0, 0, 1)
end)
