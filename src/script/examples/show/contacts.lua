-- Reports how hard a ball hits the floor.
local floor = sim:add_body("floor")
floor:add_part("floor", sim:add_plane_shape("floor"))
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { report_contacts = true, position = vec3(0, 0, 1) })
sim:on_contact(function(part, other, impulse, position)
  print(part.name, other.name, string.format("%.0f N·s, %.1f m", impulse, position.z)) --> ball floor 4 N·s, 0.0 m
end)
