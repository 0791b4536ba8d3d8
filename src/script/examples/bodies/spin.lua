-- A wheel that turns at a constant speed, with a limited torque.
local body = sim:add_body("wheel")
body:add_part("stand", sim:add_box_shape("stand", vec3(0.1, 0.1, 0.5)), { mass = 0 })
body:add_part("wheel", sim:add_cylinder_shape("wheel", 0.2, 0.05), { position = vec3(0, 0, 0.4) })
body:add_joint("axle", "stand", "wheel")
local motor = body:add_motor("axle", { mode = "spin", speed = 6, max_angular_force = 1, damping = 0.001 })
sim:after(2, function() print(string.format("%.2f", motor.joint.speed)) end) --> 6.00
sim:after(2.5, function() motor.mode = "off" end)
