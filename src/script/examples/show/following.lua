-- Follows a rolling ball, and stops after two seconds.
local ball = sim:add_body("ball", { linear_velocity = vec3(2, 0, 0) })
ball:add_part("ball", sim:add_sphere_shape("ball", 0.2), { position = vec3(0, 0, 0.2) })
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
sim:on_start(function() visuals.camera:follow(ball) end)
sim:after(2, function() visuals.camera:follow(nil) end)
