-- A door that opens by 90 degrees at most, and a drawer that slides out by half a meter.
local body = sim:add_body("cupboard", { self_collision = false })
local board = sim:add_box_shape("board", vec3(0.5, 0.05, 1))
body:add_part("frame", board, { mass = 0 })
body:add_part("door", board, { position = vec3(0.5, 0, 0) })
body:add_part("drawer", board, { position = vec3(0, 0.1, 0) })
local hinge = body:add_joint("hinge", "frame", "door", {
  type = "revolute", position = vec3(0.25, 0, 0), axis = vec3(0, 0, 1),
  angular_lower_limit = 0, angular_upper_limit = math.pi / 2,
})
local rail = body:add_joint("rail", "frame", "drawer", {
  type = "prismatic", axis = vec3(0, 1, 0), linear_lower_limit = 0, linear_upper_limit = 0.5,
})
sim:on_step(function()
  body:part("door"):apply_force(vec3(0, 5, 0))
  body:part("drawer"):apply_force(vec3(0, 5, 0))
end)
sim:after(2.5, function()
  print(hinge.parent.name, hinge.child.name, hinge.type, hinge.motor) --> frame door revolute nil
  print(string.format("%.2f rad, %.2f m", hinge.value, rail.value)) --> 1.57 rad, 0.50 m
  print(hinge.axis, math.abs(rail.speed) < 0.1) --> vec3(0, 0, 1) true
end)
