-- Reloads of scripts: callbacks, timers, handlers and `state` that persists; parameters with `rerun`.
--@ ticks 160
--@ 30 replace "0.01 * state.n" "0.02 * state.n"
--@ 50 send /scene/wind 0.4
--@ 60 replace "every(0.1" "every(0.15"
--@ 80 send /scene/count 3
--@ 100 replace "sin(3" "cos(2"
--@ 120 send /go 0.5
params { { "wind", 0.1, min = 0, max = 1 }, { "count", 2, min = 1, max = 4, rerun = true } }
state.n = state.n or 0
local box = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
sim.gravity = vec3(0, 0, -0.5)
for i = 1, params.count do sim:add_body("box" .. i):add_part("p", box, { position = vec3(i, 0, 2) }) end
sim:every(0.1, function()
  state.n = state.n + 1
  sim:body("box1").root:apply_impulse(vec3(0.01 * state.n, 0, 0.1))
end)
sim:on_step(function()
  for body in sim:bodies() do body.root:apply_force(vec3(math.sin(3 * sim.time), params.wind, 0)) end
end)
osc:on("/go", function(x) sim:body("box2").root:apply_impulse(vec3(x, x, x * state.n)) end)
