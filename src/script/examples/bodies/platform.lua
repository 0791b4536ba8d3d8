-- A platform that is moved by its position carries a box.
sim.gravity = vec3(0, 0, -9.81)
local deck = sim:add_box_shape("deck", vec3(2, 1, 0.1))
local platform = sim:add_body("platform"):add_part("deck", deck, { mass = 0, motion = "kinematic" })
local crate = sim:add_box_shape("crate", vec3(0.2, 0.2, 0.2))
local box = sim:add_body("box"):add_part("box", crate, { position = vec3(0, 0, 0.15) })
sim:on_step(function() platform.position = vec3(0.1 * sim.time ^ 2, 0, 0) end)
sim:after(2, function()
  print(string.format("%.1f m, %.1f m", platform.position.x, box.position.x)) --> 0.4 m, 0.4 m
  print(string.format("%.1f m/s", platform.linear_velocity.x)) --> 0.4 m/s
  platform.motion = "static"
end)
