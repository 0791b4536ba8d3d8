-- A ball joint with a servo on each of its three axes. One number means the own axis, a vec3 all three.
local body = sim:add_body("neck")
body:add_part("trunk", sim:add_box_shape("trunk", vec3(0.2, 0.2, 0.2)), { mass = 0 })
body:add_part("head", sim:add_sphere_shape("head", 0.1), { position = vec3(0, 0, 0.3) })
body:add_joint("neck", "trunk", "head", { type = "spherical", position = vec3(0, 0, 0.15) })
local motor = body:add_motor("neck", { angular_active = true, angular_servo_active = true })
motor.angular_velocity = vec3(2, 2, 2)
motor.angular_servo_position = vec3(0.3, 0.2, 0)
sim:after(2, function()
  local angles = motor.joint.angles
  print(string.format("%.2f %.2f %.2f", angles.x, angles.y, angles.z)) --> 0.30 0.20 0.00
end)
