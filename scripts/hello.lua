-- Hello. This is the smallest scene: a floor, a ball and a message. Play it with
--
--     ./run scripts/hello.lua
--
-- Units are meters, kilograms, seconds and radians. Z is up.

-- A body consists of parts, and a part has a shape. A plane is static: this is the ground.
local ground = sim:add_body("ground")
ground:add_part("floor", sim:add_plane_shape("floor"))

-- A ball with a radius of 10 cm, two meters above it. The table has optional properties of the part.
local ball = sim:add_body("ball")
local part = ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), {
  mass = 0.5,
  restitution = 0.8, -- fraction of the speed that remains after a bounce
  position = vec3(0, 0, 2),
})

-- The lines above describe the scene. Callbacks act while it runs: this one once per second.
sim:every(1, function()
  print(string.format("after %.0f s the ball is at %.2f m", sim.time, part.position.z))
end)

-- And this one when an OSC message /kick arrives, for example: oscsend localhost 9003 /kick f 2
osc:on("/kick", function(strength)
  part:apply_impulse(vec3(0, 0, strength or 1))
end)
