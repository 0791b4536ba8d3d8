-- An accelerometer feels no force in free fall, and the floor's push at rest.
sim.gravity = vec3(0, 0, -9.81)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local body = sim:add_body("box")
local box = body:add_part("box", sim:add_box_shape("box", vec3(0.2, 0.2, 0.2)), { position = vec3(0, 0, 2) })
local imu = box:add_imu("imu", { position = vec3(0, 0, 0.1) })
sim:after(0.2, function() print(string.format("%.2f m/s²", imu.specific_force.z)) end) --> 0.00 m/s²
sim:after(1, function()
  print(string.format("%.2f m/s²", body:sensor("imu").specific_force.z), #body.sensors) --> 9.81 m/s² 1
end)
