-- {{NAME}}: a ball on the ground that hops when it is told to. Play it with
--
--     limber play scripts/{{NAME}}.lua
--
-- Lengths are metres, masses kilograms, times seconds, angles radians. Z points up.

sim.gravity = vec3(0, 0, -9.81)

-- Bodies are made of parts, parts have shapes. A plane never moves: this is the ground.
sim:add_body("ground"):add_part("floor", sim:add_plane_shape("floor"))

local ball = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1), {
  mass = 0.5,
  restitution = 0.6, -- how much of its speed a bounce gives back
  position = vec3(0, 0, 1),
})

-- Sliders of the panel, and /scene/strength over OSC.
params {
  { "strength", 2, min = 0, max = 10, unit = "N·s", doc = "How hard a hop pushes." },
}

-- The lines above say what exists. Callbacks act while time goes on: this one whenever somebody sends /hop, such as
--     oscsend 127.0.0.1 9003 /hop
osc:on("/hop", function() ball:apply_impulse(vec3(0, 0, params.strength)) end)

-- And this one in each tick; dt is the time that the tick takes, in seconds.
sim:on_step(function(dt)
  if ball.position.z < -1 then ball.position = vec3(0, 0, 1) end
end)
