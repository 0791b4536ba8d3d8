-- Puts a ball back to its start after one second, and removes it after two.
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 3) })
sim:after(1, function()
  print(ball:part(1).position.z < 0) --> true
  ball:reset()
  print(ball:part(1).position) --> vec3(0, 0, 3)
end)
sim:after(2, function()
  ball:remove()
  print(ball.alive, sim:find_body("ball")) --> false nil
end)
