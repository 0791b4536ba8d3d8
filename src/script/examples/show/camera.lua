-- Looks at the arm from one side, and flies to the other side within two seconds.
sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
local camera = visuals.camera
camera.fovy = 50
camera:look_at(vec3(3, -3, 2), vec3(0, 0, 0.5))
print(camera.eye, string.format("%.2f m away", camera.distance)) --> vec3(3, -3, 2) 4.50 m away
sim:on_start(function() camera:look_at(vec3(-3, -3, 1), vec3(0, 0, 0.5), 2) end)
sim:after(2.5, function() print(string.format("%.1f", camera.eye.x), #camera.projection) end) --> -3.0 4
