-- A falling ball measures its height.
sim.gravity = vec3(0, 0, -10)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local ball = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 5) })
local eye = ball:add_range_finder("eye", { direction = vec3(0, 0, -1), range = 4.5 })
sim:after(0.1, function() print(eye.hit, eye.distance) end) --> false 4.5
sim:after(0.8, function()
  print(eye.hit, eye.other.name, math.abs(eye.distance - ball.position.z) < 1e-6) --> true floor true
end)
