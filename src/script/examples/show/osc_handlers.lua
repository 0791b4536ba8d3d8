-- Reacts to messages, and replies to the sender.
local ball = sim:add_body("ball")
local part = ball:add_part("ball", sim:add_sphere_shape("ball", 0.1))
osc:on("/kick", function(strength)
  if type(strength) ~= "number" then return end -- messages may have any arguments
  part:apply_impulse(vec3(0, 0, strength))
  print(osc.address, strength, osc.sender ~= nil) --> /kick 2 true
  osc:reply("/kicked", ball.name, part.linear_velocity.z)
end)
-- limber send /kick 2
