-- A quadruped stands up, then trots: diagonal legs step together, by servo targets alone.
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
local BEND = 0.6    -- what the home pose is bent by at the thigh, rad; the knee by twice that
local STANCE = 0.6  -- part of a step that a foot is on the ground
local GIVE = 0.8    -- part of a tilt that the feet on the ground follow, so that it is not thrown back

-- x, y: where the foot stands below the trunk, m; phase: diagonal legs share one
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

-- The three angles that put a foot at (x forward, y left, z up) from where it hangs. The hip swings the leg's plane
-- outward. Thigh and shin are equally long, so the leg is the sum of two unit arrows: their mean gives its
-- direction, half their difference its length.
local function reach(leg, x, y, z)
  local down = math.sqrt(y * y + z * z)
  local half = math.acos(math.clamp(math.sqrt(x * x + down * down) / (2 * LEG), 0, 1))
  local mean = math.atan2(-x, down)
  leg.hip.target = math.atan2(leg.y > 0 and y or -y, -z)
  leg.thigh.target = BEND - (mean + half)
  leg.knee.target = 2 * half - 2 * BEND
end

-- Where a foot is in its step: 0.5 .. -0.5 of its way while it is on the ground, evenly; in the air forward along an
-- arch. And how high it is raised, 0 .. 1.
local function step_of(phase)
  if phase < STANCE then return 0.5 - phase / STANCE, 0 end
  local air = (phase - STANCE) / (1 - STANCE)
  return -0.5 + air - math.sin(2 * math.pi * air) / (2 * math.pi), math.sin(math.pi * air)
end

state.phase = state.phase or 0
state.eager = state.eager or 0    -- 0 stands .. 1 lifts its feet
state.stride = state.stride or 0  -- what is told comes into force bit by bit, since feet that jump throw it over
state.turn = state.turn or 0

local function towards(now, target, most) return now + math.clamp(target - now, -most, most) end

sim:on_step(function(dt)
  if sim.time > 1 then
    state.eager = towards(state.eager, 1, dt)
    state.stride = towards(state.stride, params.stride, 0.12 * dt)
    state.turn = towards(state.turn, params.turn, dt)
  end
  state.phase = (state.phase + params.pace * dt) % 1
  local angle = state.turn * STANCE / params.pace  -- that the trunk turns by while a foot is on the ground
  local ahead, left = trunk.rotation * vec3(1, 0, 0), trunk.rotation * vec3(0, 1, 0)
  for _, leg in ipairs(legs) do
    local way, up = step_of((state.phase + leg.phase) % 1)
    local sin, cos = math.sin(angle * way), math.cos(angle * way)
    local x = state.stride * way + leg.x * (cos - 1) - leg.y * sin
    local y = leg.x * sin + leg.y * (cos - 1)
    local raised = leg.x * ahead.z + leg.y * left.z
    local give = up > 0 and 0 or GIVE * raised
    reach(leg, x, y, state.eager * (params.lift * up - give) - params.height)
  end
end)

visuals.camera.distance = 4  -- nearer than usual, and with it: it soon walks out of the picture
sim:on_start(function() visuals.camera:follow(dog) end)

osc:on("/push", function(strength) trunk:apply_impulse(vec3(0, strength or 5, 0)) end)

sim:every(1, function()
  local p = dog.position
  osc:send("/dog", p.x, p.y, p.z)
end)
