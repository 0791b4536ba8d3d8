-- A quadruped stands up, then trots: diagonal legs step together, by servo targets alone.
--
-- Try while it runs:   oscsend 127.0.0.1 9003 /scene/turn f 0.5
--                      oscsend 127.0.0.1 9003 /scene/stride f 0.16
--                      oscsend 127.0.0.1 9003 /push f 15

sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { friction = 1 })

local dog = sim:load_urdf("urdf/quadruped.urdf", { name = "dog", position = vec3(0, 0, 0.40) })
for part in dog:parts() do part.friction = 0.9 end

params {
  { "stride", 0.12, min = 0,  max = 0.2, unit = "m",  doc = "How far a foot travels on the ground; 0 trots on the spot." },
  { "pace",   1.6,  min = 0.5, max = 3,  unit = "Hz", doc = "Steps of each leg per second." },
  { "turn",   0,    min = -1, max = 1,                doc = "Left legs step shorter (positive: turns left)." },
  { "lift",   0.05, min = 0,  max = 0.1, unit = "m",  doc = "How high a foot is raised." },
  { "height", 0.35, min = 0.28, max = 0.4, unit = "m", doc = "Hips above the feet." },
}

local LEG = 0.22    -- thigh and shin, m, from joint to joint
local BEND = 0.6    -- what the home pose is bent by at the thigh, rad; the knee by twice that
local STANCE = 0.6  -- part of a step that a foot is on the ground

-- side: +1 left, −1 right; phase: diagonal legs share one
local legs = {
  { name = "front_left",  side = 1,  phase = 0 },
  { name = "back_right",  side = -1, phase = 0 },
  { name = "front_right", side = -1, phase = 0.5 },
  { name = "back_left",   side = 1,  phase = 0.5 },
}
for _, leg in ipairs(legs) do
  leg.thigh = dog:motor(leg.name .. "_thigh")
  leg.knee = dog:motor(leg.name .. "_knee")
end

-- The two angles that put a foot at (x forward, z up) from its hip. Thigh and shin are equally long, so the leg is
-- the sum of two unit arrows: their mean gives its direction, half their difference its length.
local function reach(leg, x, z)
  local half = math.acos(math.clamp(math.sqrt(x * x + z * z) / (2 * LEG), 0, 1))
  local mean = math.atan2(-x, -z)
  leg.thigh.target = BEND - (mean + half)
  leg.knee.target = 2 * half - 2 * BEND
end

-- Where a foot is in its step: on the ground it moves back evenly, in the air forward along an arch.
local function step_of(phase, stride, lift)
  if phase < STANCE then return stride * (0.5 - phase / STANCE), 0 end
  local air = (phase - STANCE) / (1 - STANCE)
  return stride * (-0.5 + air - math.sin(2 * math.pi * air) / (2 * math.pi)), lift * math.sin(math.pi * air)
end

state.phase = state.phase or 0
state.eager = state.eager or 0  -- 0 stands .. 1 trots in full stride

sim:on_step(function(dt)
  if sim.time > 1 then state.eager = math.min(1, state.eager + dt) end
  state.phase = (state.phase + params.pace * dt) % 1
  for _, leg in ipairs(legs) do
    local stride = state.eager * params.stride * (1 - leg.side * params.turn)
    local x, up = step_of((state.phase + leg.phase) % 1, stride, state.eager * params.lift)
    reach(leg, x, up - params.height)
  end
end)

osc:on("/push", function(strength) dog:part("trunk"):apply_impulse(vec3(0, strength or 10, 0)) end)

sim:every(1, function()
  local p = dog.position
  osc:send("/dog", p.x, p.y, p.z)
end)
