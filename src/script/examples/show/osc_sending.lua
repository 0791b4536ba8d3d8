-- Sends the height of a ball ten times a second to all targets, and a greeting to one address.
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 1) })
local lights = osc:to("127.0.0.1:9010")
print(lights) --> 127.0.0.1:9010
sim:on_start(function() lights:send("/light/1", 0.5, true, "warm") end)
sim:every(0.1, function() osc:send("/ball", ball.position) end)
