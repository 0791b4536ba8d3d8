-- Two rings of eight arms face each other, one standing, one hanging, and sway in slow waves that run round the rings.
-- Sliders: speed, depth, lag. From outside: /sway 1 lets a gust go through all arms, /sway 1 "arm3" through one.

local kArms = 8 -- in each ring
local kRadius = 2.5 -- m
local kHeight = 5 -- m, of the upper ring

sim.gravity = vec3(0, 0, -9.81)

params {
  { "speed", 0.12, min = 0, max = 1, unit = "Hz", doc = "Waves per second." },
  { "depth", 0.6, min = 0, max = 1.2, unit = "rad", doc = "How far the joints bend." },
  { "lag", 0.6, min = 0, max = 3.14, unit = "rad", doc = "How much later than the one below a joint bends." },
}

-- one arm from its file; the others are copies, each turned to face outwards
local arms = {}
local function add_arm(name, angle, height, up)
  local pose = {
    position = vec3(kRadius * math.cos(angle), kRadius * math.sin(angle), height),
    rotation = quat.euler(up and 0 or math.pi, 0, angle - math.pi / 2),
  }
  if arms[1] then
    return arms[1].body:copy(name, pose)
  end
  pose.name = name
  return sim:load_urdf("urdf/arm6.urdf", pose)
end

for i = 1, 2 * kArms do
  local place = (i - 1) % kArms
  local angle = -math.pi / 2 + 2 * math.pi * place / kArms
  local up = i <= kArms
  local body = add_arm("arm" .. i, angle, up and 0 or kHeight, up)
  -- turned over, an arm leans the other way; half a wave later, the upper ring follows the lower one
  arms[i] = { body = body, phase = 2 * math.pi * place / kArms + (up and 0 or math.pi), gust = 0 }
end

-- odd joints twist, even ones bend; every joint follows the same wave, a little later than the one below
local function sway(arm, time, dt)
  local depth = math.min(params.depth * (1 + arm.gust), 1.3)
  local lag = params.lag
  for i, motor in ipairs(arm.body.motors) do
    if i % 2 == 1 then
      motor.target = 0.6 * depth * math.sin(0.5 * time - arm.phase - 0.4 * i)
    else
      motor.target = depth * (0.1 + (0.5 + 0.1 * i) * math.sin(time - arm.phase - lag * i / 2))
    end
  end
  arm.gust = arm.gust * math.exp(-dt / 1.5)
end

state.time = state.time or 0
sim:on_step(function(dt)
  -- a phase that is summed up, so that a new speed does not make the arms jump
  state.time = state.time + 2 * math.pi * params.speed * dt
  for _, arm in ipairs(arms) do sway(arm, state.time, dt) end
end)

osc:on("/sway", function(strength, name)
  for _, arm in ipairs(arms) do
    if name == nil or arm.body.name == name then arm.gust = math.min(arm.gust + (strength or 1), 2) end
  end
end)
