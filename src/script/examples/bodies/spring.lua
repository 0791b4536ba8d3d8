-- A spring swings back to its rest angle.
local body = sim:add_body("spring")
body:add_part("stand", sim:add_box_shape("stand", vec3(0.1, 0.1, 0.5)), { mass = 0 })
body:add_part("blade", sim:add_box_shape("blade", vec3(0.02, 0.2, 0.6)), { position = vec3(0, 0, 0.7) })
body:add_joint("hinge", "stand", "blade", { position = vec3(0, 0, 0.4), axis = vec3(0, 1, 0) })
local motor = body:add_motor("hinge", {
  mode = "spring", target = 0.3, angular_spring_stiffness = 200, angular_spring_damping = 4,
})
sim:after(2.5, function()
  print(string.format("%.1f", motor.joint.value), motor.angular_spring_stiffness.z) --> 0.3 200
end)
