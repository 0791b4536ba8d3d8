-- {{NAME}}: a reed of three pieces that sways. Play it with
--
--     limber play scripts/main.lua
--
-- Units: meters, kilograms, seconds, radians. Z points up.

-- Bodies consist of parts, and parts have shapes. Planes are static: this one is the ground.
sim:add_body("ground"):add_part("floor", sim:add_plane_shape("floor"))

-- A body from a file. Its joints have motors, which hold them at their targets.
local reed = sim:load_urdf("urdf/reed.urdf", { name = "reed" })

-- Parameters: sliders in the panel, and /scene/depth over OSC: oscsend 127.0.0.1 9003 /scene/depth f 0.5
params {
  { "speed", 0.3, min = 0, max = 2, unit = "Hz", doc = "Waves per second." },
  { "depth", 0.25, min = 0, max = 0.6, unit = "rad", doc = "Amplitude of each joint." },
}

-- The lines above create the objects. Callbacks run while the scene plays: this one in each tick. Values in `state`
-- survive when this file is saved and reloaded.
state.phase, state.gust = state.phase or 0, state.gust or 0
sim:on_step(function(dt)
  state.phase = state.phase + 2 * math.pi * params.speed * dt
  state.gust = state.gust * math.exp(-dt / 0.8) -- fades within a second or two
  for i, motor in ipairs(reed.motors) do
    motor.target = state.gust + params.depth * math.sin(state.phase - 0.8 * i)
  end
end)

-- And this one for each message /gust: oscsend 127.0.0.1 9003 /gust f 0.4
osc:on("/gust", function(strength) state.gust = strength or 0.4 end)
