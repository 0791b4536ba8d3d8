-- Sensors, contact points, joint loads, rays and zones, whose readings act on the bodies.
--@ ticks 240
--@ 60 again 30
--@ 100 replace "radius = 0.6" "radius = 0.8"
--@ 130 replace "--MORE" "post:add_range_finder('more', { direction = vec3(0, 1, -0.2) })"
--@ take
params { { "entered", 0 }, { "left", 0 }, { "stayed", 0 }, { "ended", 0 } }
sim.gravity = vec3(0, 0, -9.81)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { restitution = 0.6 })
local box, ball = sim:add_box_shape("box", vec3(0.2, 0.25, 0.15)), sim:add_sphere_shape("ball", 0.1)
local post = sim:add_body("post"):add_part("post", ball, { mass = 0, position = vec3(0, 0, 0.4) })
post:add_zone("gate", { radius = 0.6 })
--MORE
local stone = sim:add_body("stone1")
stone:add_part("p", box, { report_contacts = true, restitution = 0.4 })
stone:add_part("tail", ball, { position = vec3(0.25, 0, 0), mass = 0.3 })
stone:add_joint("neck", "p", "tail", { type = "fixed", position = vec3(0.12, 0, 0) })
stone:part("p"):add_imu("imu", { position = vec3(0.05, 0, 0) })
stone:part("p"):add_range_finder("eye", { direction = vec3(0.3, 0.1, -1), range = 3 })
stone:part("tail"):add_touch("skin", { radius = 0.08, position = vec3(0.05, 0, 0) })
stone.position, stone.rotation = vec3(0.1, 0, 0.8), quat.euler(0.3, 0.2, 0.1)
for i = 2, 5 do
  stone:copy("stone" .. i, { position = vec3(0.11 * (i % 3), 0.1 * (i % 2), 0.5 + 0.35 * i), rotation = quat.euler(i, 1, 0) })
end
sim:on_zone_enter(function(_, part)
  params.entered = params.entered + 1
  part:apply_impulse(vec3(0.05, 0, 0.1))
end)
sim:on_zone_leave(function() params.left = params.left + 1 end)
sim:on_contact_stay(function(_, _, impulse) params.stayed = params.stayed + impulse end)
sim:on_contact_end(function(_, _, _, position) params.ended = params.ended + position.x end)
local into = {}
sim:on_step(function()
  for body in sim:bodies("stone*") do
    local part = body:part("p")
    local push = vec3(0, 0, 0)
    for _, point in ipairs(part:contacts()) do push = push + 0.05 * point.friction + 0.01 * point.force * point.normal end
    part:apply_force(push + 0.02 * body:joint("neck").reaction_force)
    part:apply_torque(0.001 * body:sensor("imu").specific_force + 0.01 * body:joint("neck").reaction_torque)
    part:apply_force(vec3(0.1 * body:sensor("eye").distance, 0.001 * body:sensor("skin").force, 0))
  end
  local distances = sim:rays(vec3(0, 0, 1), { vec3(1, 0, 0), vec3(-1, 0, 0.2) }, { into = into })
  if distances[1] < 1 then sim:body("stone1"):part("p"):apply_force(vec3(0, distances[1], 0)) end
  local near = sim:overlap_sphere(vec3(0, 0, 0.3), 0.5, { ignore = sim:body("floor") })
  near[1]:apply_force(vec3(0, 0.01 * sim.kinetic_energy, 0))
end)
