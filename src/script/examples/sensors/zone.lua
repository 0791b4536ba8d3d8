-- A ball crosses a zone around a post.
sim.gravity = vec3(0, 0, 0)
local post = sim:add_body("post"):add_part("post", sim:add_sphere_shape("post", 0.1), { mass = 0 })
local gate = post:add_zone("gate", { position = vec3(0, 0, 1), radius = 0.5 })
local ball = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(-2, 0, 1) })
sim:on_start(function() ball.linear_velocity = vec3(2, 0, 0) end)
sim:on_zone_enter(function(zone, part) print(zone.name, part.name, "enters", zone.count) end) --> gate ball enters 1
sim:on_zone_leave(function(zone, part) print(zone.name, part.name, "leaves", zone.count) end) --> gate ball leaves 0
