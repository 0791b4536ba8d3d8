-- A show: a field of reeds in the wind, with presets, and cues over OSC.
-- docs/learn/study_show.md builds it step by step.

-- View
visuals.camera:look_at(vec3(0, -6.5, 2.2), vec3(0, 0, 0.7))

-- Field: the first reed comes from its file, the others are copies
local kRows = 9 -- rows and columns
local kGap = 0.55 -- m
local first = sim:load_urdf("urdf/reed.urdf", { name = "reed1" })
local reeds = {}
for i = 1, kRows * kRows do
  local column, row = (i - 1) % kRows, math.floor((i - 1) / kRows)
  local middle = (kRows - 1) / 2
  local place = (vec3(column - middle, row - middle, 0) + rng:uniform(vec3(-0.3, -0.3, 0), vec3(0.3, 0.3, 0))) * kGap
  if i == 1 then
    first.position = place
    reeds[i] = first
  else
    reeds[i] = first:copy("reed" .. i, { position = place })
  end
end

-- Sliders
params {
  { "speed", 0.3, min = 0, max = 2, unit = "Hz", doc = "Waves per second." },
  { "depth", 0.2, min = 0, max = 0.6, unit = "rad", doc = "Amplitude of each joint." },
  { "length", 3, min = 0.5, max = 10, unit = "m", doc = "Distance from one wave to the next." },
  { "lean", 0.05, min = -0.4, max = 0.4, unit = "rad", doc = "How far the wind bends each joint." },
}

-- Wind: waves that travel over the field
state.phase, state.gust = state.phase or 0, state.gust or 0
sim:on_step(function(dt)
  state.phase = state.phase + 2 * math.pi * params.speed * dt
  state.gust = state.gust * math.exp(-dt / 0.8)
  for _, reed in ipairs(reeds) do
    local place = reed.position
    local phase = state.phase - 2 * math.pi * (place.x + 0.4 * place.y) / params.length
    for i, motor in ipairs(reed.motors) do
      motor.target = params.lean + state.gust + params.depth * math.sin(phase - 0.8 * i)
    end
  end
end)

-- Cues: /cue storm 4 morphs to the preset storm in 4 s
osc:on("/cue", function(name, seconds) presets:recall(name, seconds or 4) end)

-- Gust: /gust 0.4 bends all reeds, for about a second
osc:on("/gust", function(strength) state.gust = math.clamp(strength or 0.4, -0.6, 0.6) end)
