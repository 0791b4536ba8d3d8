-- Holds a ball against gravity, turns it with a torque, and kicks it once.
local ball = sim:add_body("ball")
local part = ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { mass = 2, position = vec3(0, 0, 1) })
sim:on_step(function()
  part:apply_force(vec3(0, 0, 2 * 9.81)) -- a force acts for one tick, so a lasting one is applied in each tick
  part:apply_torque(vec3(0, 0, 0.01))
end)
sim:after(1, function()
  print(string.format("%.3f", part.position.z), part.angular_velocity.z > 0) --> 1.000 true
  part:apply_impulse(vec3(4, 0, 0)) -- changes the velocity by impulse / mass, in the next step
end)
sim:after(1.1, function() print(string.format("%.2f m/s", part.linear_velocity.x)) end) --> 2.00 m/s
