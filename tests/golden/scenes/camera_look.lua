-- Appearance as part of the state: the camera that glides and follows, materials, the look.
--@ ticks 100
--@ 20 send /visuals/shape/diffusecolor ball 0.1 0.5 0.7
--@ 40 send /visuals/camera/rotation -80 0 -24
--@ 60 send /visuals/look/style studio
local ball = sim:add_sphere_shape("ball", 0.1)
local body = sim:add_body("ball")
body:add_part("p", ball, { position = vec3(0, 0, 3), linear_velocity = vec3(1, 0.5, 4) })
visuals.camera:look_at(vec3(4, -5, 2), vec3(0, 0, 1))
sim:on_start(function() visuals.camera:look_at(vec3(2, 3, 2), vec3(0.3, 0.2, 1), 0.5) end)
sim:at(1, function() visuals.camera:follow(body) end)
