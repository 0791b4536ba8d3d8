-- {{NAME}}: a ball on the ground that hops on an OSC message. Play it with
--
--     limber play scripts/{{NAME}}.lua
--
-- Units: meters, kilograms, seconds, radians. Z points up.

sim.gravity = vec3(0, 0, -9.81)

-- Bodies consist of parts, and parts have shapes. Planes are static: this one is the ground.
sim:add_body("ground"):add_part("floor", sim:add_plane_shape("floor"))

local ball = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1), {
  mass = 0.5,
  restitution = 0.6, -- fraction of the speed that a bounce preserves
  position = vec3(0, 0, 1),
})

-- Parameters: sliders in the panel, and /scene/strength over OSC.
params {
  { "strength", 2, min = 0, max = 10, unit = "N·s", doc = "Impulse of a hop." },
}

-- The lines above create the objects. Callbacks run while the scene plays: this one for each message /hop, such as
--     oscsend 127.0.0.1 9003 /hop
osc:on("/hop", function() ball:apply_impulse(vec3(0, 0, params.strength)) end)

-- And this one in each tick; dt is the duration of the tick in seconds.
sim:on_step(function(dt)
  if ball.position.z < -1 then ball.position = vec3(0, 0, 1) end
end)
