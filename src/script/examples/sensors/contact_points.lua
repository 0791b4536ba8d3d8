-- A ball of 1 kg on the floor: its weight, and the end of the contact when it is lifted.
sim.gravity = vec3(0, 0, -9.81)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local ball = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1),
  { position = vec3(0, 0, 0.1), report_contacts = true })
local ticks = 0
sim:on_contact_stay(function(part, other, impulse) ticks = ticks + 1 end)
sim:after(1, function()
  print(string.format("%.2f N, %d point", ball.contact_normal_force, ball.contact_count)) --> 9.81 N, 1 point
  for _, point in ipairs(ball:contacts()) do
    print(point.part.name, point.normal, string.format("%.2f N", point.force)) --> floor vec3(0, 0, 1) 9.81 N
  end
  ball.linear_velocity = vec3(0, 0, 3)
end)
sim:on_contact_end(function(part, other) print(part.name, "left", other.name, ticks > 50) end) --> ball left floor true
