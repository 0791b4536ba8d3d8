-- A show of ninety seconds: a dancer between two rings of eight arms, and sixteen moving heads. The arms sway, bow to
-- the dancer and strike with the beat; the heads follow her hands or the tips of the arms.
--
-- The cues follow one another by themselves; F5 starts the next one early. They are in show.cues.json, their looks in
-- show.presets.json; both can be edited while the show plays. F7 taps the tempo, --link takes it from other programs,
-- Ctrl+L sends the values of the heads to real lights. docs/howto/clock.md and docs/howto/cues.md explain the rest.

local kArms, kRadius, kHeight = 8, 2.6, 4.6 -- arms in each ring; m; m, height of the upper ring
local kTempo = 120 -- beats per minute in which the dance takes four bars

params {
  { "sway", 0.1, min = 0, max = 1, doc = "Slow waves around the rings." },
  { "bow", 0, min = 0, max = 1, doc = "How far the arms bow to the dancer." },
  { "strike", 0, min = 0, max = 1, doc = "How far the arms move with the beat." },
  { "energy", 0.3, min = 0, max = 1, doc = "How much the speed of the dancer adds to the waves." },
  { "light", 0.1, min = 0, max = 1, doc = "Brightness of the moving heads." },
  { "hue", 0.58, min = 0, max = 1, doc = "Hue of the lower ring; the upper one is opposite." },
  { "flash", 0, min = 0, max = 1, doc = "How much the light pulses with the beat." },
  { "on_arms", false, doc = "The moving heads follow the arms; else the dancer." },
}

sim.gravity = vec3(0, 0, -9.81)
sim.clock.tempo = kTempo
visuals.look.style = "stage"
visuals.look.lamp, visuals.look.ambient, visuals.look.rim = 0.4, 0.45, 0.8
visuals.camera:look_at(vec3(4.6, -7.4, 2.6), vec3(0, 0, 2))
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))

-- The dancer: her dance fills four bars at any tempo
local dancer = sim:add_mocap("dancer", { source = "motion/dancer.bvh", unit = "cm" })
local figure = dancer:add_body("figure", { radius = 0.055 })
for part in figure:parts() do part.tint = vec3(0.1, 0.35, 0.95) end
local hands = { figure:part("left_hand"), figure:part("right_hand") }

-- The rings: one stands, one hangs; both face the dancer
local first = sim:load_urdf("urdf/arm6.urdf", { name = "arm1", motors = "servo" })
local arms = {}
for i = 1, 2 * kArms do
  local upper = i > kArms
  local angle = 2 * math.pi * (i - 1 + (upper and 0.5 or 0)) / kArms
  local pose = {
    position = vec3(kRadius * math.cos(angle), kRadius * math.sin(angle), upper and kHeight or 0),
    rotation = quat.euler(upper and math.pi or 0, 0, angle - math.pi / 2),
  }
  local body = first
  if i == 1 then
    first.position, first.rotation = pose.position, pose.rotation
  else
    body = first:copy("arm" .. i, pose)
  end
  -- leaning to the middle is a positive bend of a standing arm
  arms[i] = { body = body, tip = body:part("tip"), angle = angle, upper = upper, inward = upper and -1 or 1 }
end

-- Sixteen heads on a round truss, each with its arm; odd ones take the left hand
local heads = {}
for i, arm in ipairs(arms) do
  local radius = arm.upper and 4.6 or 3.9
  heads[i] = sim:add_fixture("head_" .. i, {
    profile = "moving_spot", universe = 1 + math.floor((i - 1) / kArms),
    position = vec3(radius * math.cos(arm.angle), radius * math.sin(arm.angle), 5.4), rotation = vec3(180, 0, 0),
    targets = { hands[1 + i % 2], arm.tip }, aim = "part", zoom = 9,
  })
end

-- 1 on a beat, and less and less until the next one
local function pulse(beat) return math.exp(-5 * (beat % 1)) end

sim:on_step(function()
  local clock = sim.clock
  local beat = clock.beat
  dancer.speed = clock.current_tempo / kTempo
  dancer.playing = clock.playing
  local energy = params.energy * math.min(1, dancer.mean_speed / 1.2)
  for i, arm in ipairs(arms) do
    -- a wave around the ring in eight beats, and strikes that travel around it, one arm on each half beat
    local wave = math.sin(2 * math.pi * beat / 8 - arm.angle)
    local strike = params.strike * pulse(beat / 4 - arm.angle / (2 * math.pi) + (arm.upper and 0.5 or 0))
    local bend = (params.sway + energy) * wave + 0.55 * params.bow + 0.6 * strike
    local motors = arm.body.motors
    for k = 2, 6, 2 do motors[k].target = arm.inward * bend * (k == 2 and 0.7 or 1) end
    motors[1].target = (params.sway + energy) * 0.8 * math.sin(2 * math.pi * beat / 16 + 2 * arm.angle)
    local hue = (params.hue + (arm.upper and 0.5 or 0)) % 1
    arm.tip.tint = vec3(hue, 0.8, 0.25 + 0.75 * math.max(strike, energy))
    local head = heads[i]
    head.target = params.on_arms and 2 or 1
    head.dimmer = params.light * (1 - params.flash + params.flash * pulse(beat + (i % 2) / 2))
    head.color = vec3(hue, 0.7, 1)
  end
end)
