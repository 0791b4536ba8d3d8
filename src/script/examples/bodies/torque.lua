-- A wheel (0.02 kg·m²) and the rotor of its motor, which a constant torque accelerates.
local body = sim:add_body("wheel")
body:add_part("stand", sim:add_box_shape("stand", vec3(0.1, 0.1, 0.5)), { mass = 0 })
body:add_part("wheel", sim:add_cylinder_shape("wheel", 0.2, 0.05), { position = vec3(0, 0, 0.4) })
local axle = body:add_joint("axle", "stand", "wheel", { armature = 0.03 })
local motor = body:add_motor(axle, { mode = "torque", target_torque = 0.02 })
sim:after(1, function() print(string.format("%.2f rad/s", axle.speed)) end) --> 0.40 rad/s
sim:after(1.5, function() motor.no_load_speed = 2 end) -- the torque decreases to 0 at 2 rad/s
