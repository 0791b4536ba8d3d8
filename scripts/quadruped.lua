-- A quadruped stands up, then trots: diagonal legs step together, driven by servo targets only.
--
-- Try while it runs:   oscsend 127.0.0.1 9003 /scene/turn f 0.5
--                      oscsend 127.0.0.1 9003 /scene/stride f 0.16
--                      oscsend 127.0.0.1 9003 /push f 5

sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { friction = 1 })

local dog = sim:load_urdf("urdf/quadruped.urdf", { name = "dog", position = vec3(0, 0, 0.40) })
for part in dog:parts() do part.friction = 0.9 end

params {
  { "stride", 0.12, min = 0,  max = 0.2, unit = "m",  doc = "How far a foot travels on the ground; 0 trots on the spot." },
  { "pace",   2,    min = 0.5, max = 3,  unit = "Hz", doc = "Steps of each leg per second." },
  { "turn",   0,    min = -1, max = 1,  unit = "rad/s", doc = "How fast it turns (positive: left); on the spot where the stride is 0." },
  { "lift",   0.04, min = 0,  max = 0.1, unit = "m",  doc = "How high a foot is raised." },
  { "height", 0.35, min = 0.28, max = 0.4, unit = "m", doc = "Hips above the feet." },
}

local LEG = 0.22    -- thigh and shin, m, from joint to joint
local BEND = 0.6    -- bend of the thigh in the home pose, rad; the knee bends by twice that angle
local STANCE = 0.6  -- fraction of a step that a foot is on the ground
local COMPLIANCE = 0.8    -- fraction of a tilt that the feet on the ground follow, to avoid a counter-force

-- x, y: foot position below the trunk, m; phase: equal for diagonal legs
local legs = {
  { name = "front_left",  x = 0.18,  y = 0.14,  phase = 0 },
  { name = "back_right",  x = -0.18, y = -0.14, phase = 0 },
  { name = "front_right", x = 0.18,  y = -0.14, phase = 0.5 },
  { name = "back_left",   x = -0.18, y = 0.14,  phase = 0.5 },
}
for _, leg in ipairs(legs) do
  leg.hip = dog:motor(leg.name .. "_hip")
  leg.thigh = dog:motor(leg.name .. "_thigh")
  leg.knee = dog:motor(leg.name .. "_knee")
end
local trunk = dog:part("trunk")

-- Sets the three angles that move a foot to (x forward, y left, z up), relative to its hip. The hip swings the leg's
-- plane outward. Thigh and shin are equally long, so the leg is the sum of two unit vectors: their mean angle gives its
-- direction, half their difference its length.
local function reach(leg, x, y, z)
  local down = math.sqrt(y * y + z * z)
  local half = math.acos(math.clamp(math.sqrt(x * x + down * down) / (2 * LEG), 0, 1))
  local mean = math.atan2(-x, down)
  leg.hip.target = math.atan2(leg.y > 0 and y or -y, -z)
  leg.thigh.target = BEND - (mean + half)
  leg.knee.target = 2 * half - 2 * BEND
end

-- Returns the position of a foot in its step, from 0.5 to -0.5: linear on the ground, in the air forward along an arch;
-- and the height, 0 .. 1.
local function step_of(phase)
  if phase < STANCE then return 0.5 - phase / STANCE, 0 end
  local air = (phase - STANCE) / (1 - STANCE)
  return -0.5 + air - math.sin(2 * math.pi * air) / (2 * math.pi), math.sin(math.pi * air)
end

state.phase = state.phase or 0
state.eager = state.eager or 0    -- 0 stands .. 1 lifts its feet
state.stride = state.stride or 0  -- follows the slider slowly, since sudden foot movements would topple it
state.turn = state.turn or 0

local function towards(now, target, max_change) return now + math.clamp(target - now, -max_change, max_change) end

sim:on_step(function(dt)
  if sim.time > 1 then
    state.eager = towards(state.eager, 1, dt)
    state.stride = towards(state.stride, params.stride, 0.12 * dt)
    state.turn = towards(state.turn, params.turn, dt)
  end
  state.phase = (state.phase + params.pace * dt) % 1
  local angle = state.turn * STANCE / params.pace  -- angle that the trunk turns while a foot is on the ground
  local ahead, left = trunk.rotation * vec3(1, 0, 0), trunk.rotation * vec3(0, 1, 0)
  for _, leg in ipairs(legs) do
    local way, up = step_of((state.phase + leg.phase) % 1)
    local sin, cos = math.sin(angle * way), math.cos(angle * way)
    local x = state.stride * way + leg.x * (cos - 1) - leg.y * sin
    local y = leg.x * sin + leg.y * (cos - 1)
    local raised = leg.x * ahead.z + leg.y * left.z
    local tilt = up > 0 and 0 or COMPLIANCE * raised
    reach(leg, x, y, state.eager * (params.lift * up - tilt) - params.height)
  end
end)

visuals.camera.distance = 4  -- closer than the default
sim:on_start(function() visuals.camera:follow(dog) end)  -- otherwise it soon walks out of view

osc:on("/push", function(strength) trunk:apply_impulse(vec3(0, strength or 5, 0)) end)

sim:every(1, function()
  local p = dog.position
  osc:send("/dog", p.x, p.y, p.z)
end)
