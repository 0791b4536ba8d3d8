-- Timers: every, after, at, canceled, made in callbacks; intervals that are not a multiple of the tick.
--@ ticks 150
--@ 80 send /physics/sim/timestep 0.013
local box = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
sim.gravity = vec3(0, 0, -1)
local body = sim:add_body("box")
local part = body:add_part("p", box, { position = vec3(0, 0, 3) })
local function push(x, y, z) part:apply_impulse(vec3(x, y, z) * 0.1) end
local steady = sim:every(0.07, function() push(0, 0, 0.3) end)
sim:every(0.11, function() push(rng:uniform(-1, 1), 0, 0) end)
sim:after(0.5, function() sim:after(0.033, function() push(0, 2, 0) end) end)
sim:at(1, function()
  steady:cancel()
  sim:every(0.25, function() push(0, -0.5, 0.9) end)
end)
sim:on_start(function() push(1, 1, 1) end)
