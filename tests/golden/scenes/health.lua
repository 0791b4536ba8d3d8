-- The stability check: parts that become too fast are restored, then disabled, and the rest plays on.
--@ ticks 120
--@ faults 3
local ball = sim:add_sphere_shape("ball", 0.1)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
for i = 1, 3 do sim:add_body("ball" .. i):add_part("p", ball, { position = vec3(i, 0, 0.5) }) end
sim:at(0.5, function() sim:body("ball1").root:apply_impulse(vec3(0, 0, 900)) end)
sim:at(1, function() sim:body("ball1").root:apply_impulse(vec3(0, 0, 900)) end)
sim:at(1.5, function() sim:body("ball2").root.linear_velocity = vec3(600, 0, 0) end)
