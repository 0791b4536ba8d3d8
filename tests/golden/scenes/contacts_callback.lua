-- sim:on_contact: scripts that use impulses and positions of new contacts.
--@ ticks 150
params { { "sum", 0 } }
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { restitution = 0.9 })
local box = sim:add_box_shape("box", vec3(0.2, 0.25, 0.15))
for i = 1, 8 do
  local body = sim:add_body("stone" .. i)
  body:add_part("p", box, {
    position = vec3(0.06 * (i % 4), 0.05 * (i % 3), 0.2 + 0.3 * i), rotation = quat.euler(0.1 * i, 0.2, 0.3),
    report_contacts = true, restitution = 0.4,
  })
end
sim:on_contact(function(part, other, impulse, position)
  params.sum = params.sum + impulse * position.x
  part:apply_impulse((part.center - position):normalized() * math.min(0.2 * impulse, 0.5))
end)
