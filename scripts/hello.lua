-- Hello. This is the smallest scene: a floor, a ball, and one thing to do. Play it with
--
--     ./run scripts/hello.lua
--
-- Lengths are metres, masses kilograms, times seconds, angles radians. Z points up.

-- A body is made of parts, a part has a shape. A plane never moves: this is the ground.
local ground = sim:add_body("ground")
ground:add_part("floor", sim:add_plane_shape("floor"))

-- A ball of 20 cm, two metres above it. What stands in { } is optional; every property of a part can.
local ball = sim:add_body("ball")
local part = ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), {
  mass = 0.5,
  restitution = 0.8, -- how much of its speed a bounce gives back
  position = vec3(0, 0, 2),
})

-- The lines above say what exists. Callbacks act, while time goes on: this one once a second.
sim:every(1, function()
  print(string.format("after %.0f s the ball is at %.2f m", sim.time, part.position.z))
end)

-- And this one whenever somebody sends /kick, for example: oscsend localhost 9003 /kick f 2
osc:on("/kick", function(strength)
  part:apply_impulse(vec3(0, 0, strength or 1))
end)
