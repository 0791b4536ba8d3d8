-- A weight of 2 kg hangs on a cable that runs along the beam of a crane.
sim.gravity = vec3(0, 0, -9.81)
local ball = sim:add_sphere_shape("ball", 0.1)
local crane = sim:add_body("crane")
crane:add_part("beam", sim:add_box_shape("beam", vec3(2, 0.1, 0.1)), { mass = 0, position = vec3(0, 0, 3) })
crane:add_part("heavy", ball, { mass = 2, position = vec3(1, 0, 1) })
local cable = crane:add_tendon("cable", {
  points = { { "heavy" }, { "beam", 1, 0, 0 }, { "beam", -1, 0, 0 } },
  stiffness = 5000, damping = 200,
})
print(#cable.points, cable.points[2].part.name, cable.length) --> 3 beam 4
sim:after(0.6, function()
  print(string.format("%.2f N, %.4f m", cable.force, cable.length)) --> 19.62 N, 4.0039 m
  crane:tendon("cable").tension = 22 -- lifts it
end)
sim:after(1, function()
  print(crane:part("heavy").position.z > 1, #crane.tendons) --> true 1
  cable:remove()
  print(cable.alive) --> false
end)
