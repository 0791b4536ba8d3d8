-- A pendulum on a ball joint whose axis is horizontal: it sinks, and leans on its cone.
sim.gravity = vec3(0, 0, -9.81)
local body = sim:add_body("pendulum")
body:add_part("post", sim:add_sphere_shape("post", 0.05), { mass = 0 })
body:add_part("rod", sim:add_box_shape("rod", vec3(0.4, 0.05, 0.1)), { position = vec3(0.25, 0, 0) })
local joint = body:add_joint("ball", "post", "rod", {
  type = "spherical", position = vec3(0, 0, 0), axis = vec3(1, 0, 0),
  cone_limit = 0.6, twist_lower = -0.2, twist_upper = 0.2,
})
body:add_motor(joint, { mode = "off", damping = 0.2 })
sim:after(0.9, function()
  print(string.format("%.2f rad", joint.swing)) --> 0.60 rad
  print(math.abs(joint.twist) < 0.201) --> true
end)
