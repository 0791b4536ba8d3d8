-- Two rings of eight arms facing each other, one standing, one hanging, breathe in slow waves that travel around the
-- rings. Sliders: rate, depth, lag. OSC: /sway 1 sends a gust through all arms, /sway 1 "arm3" through one.
--
-- Each arm has 21 more behaviors that can be switched on, alone or together:
--   /physics/body/arm3/behavior/thrusting/active 1       one arm
--   /physics/body/*/behavior/staccato/active 1           all arms
--   /physics/group/cohesion/active 1                     all tips together

local kArms = 8 -- in each ring
local kRadius = 2.5 -- m
local kHeight = 5 -- m, height of the upper ring

sim.gravity = vec3(0, 0, -9.81)
visuals.camera:look_at(vec3(6.6, -8.6, 3.2), vec3(0, 0, 2.3))

params {
  { "rate", 0.12, min = 0, max = 1, unit = "Hz", doc = "Breaths per second, of all arms." },
  { "depth", 0.6, min = 0, max = 1.2, unit = "rad", doc = "How far the joints bend." },
  { "lag", 0.6, min = 0, max = 3.14, unit = "rad", doc = "Phase lag of each joint behind the one below." },
}

-- the first arm, from its file; the others are copies of it with all its behaviors
local first = sim:load_urdf("urdf/arm6.urdf", { name = "arm1" })
local tip = first:part("tip")

-- even joints bend the arm; odd ones twist it at half the rate and half the amplitude
first:add_behavior("breathe", "bend", { motors = "joint_[246]" })
first:add_behavior("breathe", "twist", { motors = "joint_[135]" })

local function add(type, name, opts)
  opts.active = false
  first:add_behavior(type, name, opts)
end
-- a force of 1 N in a random direction that changes every 5 s
local function pushing(parts) return { parts = parts, min_amp = 1, max_amp = 1, rand_interval = 5000 } end
add("random_force", "random_tip", pushing(tip))
add("random_force", "random_all", pushing("all"))
add("force", "force_tip", { parts = tip, dir = vec3(1, 0, 0), amp = 1 })
for i, motor in ipairs(first.motors) do
  add("rotation_target", "rotation_" .. i - 1, { motors = motor, speed = 1.4 })
end
add("speed", "speed_tip", { parts = tip })
add("speed", "speed_all", {})
add("target_attraction", "targetpos_tip", { parts = tip, target_pos = vec3(0, 2, 0), max_amp = 1 })
add("target_attraction", "targetpos_all", { target_pos = vec3(0, 2, 0), max_amp = 1 })
add("random_force", "levitation", pushing(tip))
add("random_force", "particles", pushing(tip))
-- random joint targets up to 1.4 rad in both directions
local function drawn(motors, speed, interval)
  return { motors = motors, min_target = vec3(0, 0, -1.4), max_target = vec3(0, 0, 1.4), speed = speed,
    rand_interval = interval }
end
add("random_rotation_target", "thrusting", drawn({ "joint_1", "joint_2" }, 1.4, 2000))
add("random_rotation_target", "staccato", drawn("all", 1.4, 2000))
add("random_rotation_target", "fluidity", drawn("all", 0.1, 1000))

-- the rings: each arm faces outwards, with a phase that increases along the ring
local arms = {}
for i = 1, 2 * kArms do
  local place, up = (i - 1) % kArms, i <= kArms
  local angle = -math.pi / 2 + 2 * math.pi * place / kArms
  local pose = {
    position = vec3(kRadius * math.cos(angle), kRadius * math.sin(angle), up and 0 or kHeight),
    rotation = quat.euler(up and 0 or math.pi, 0, angle - math.pi / 2),
  }
  local body = first
  if i == 1 then
    first.position, first.rotation = pose.position, pose.rotation
  else
    body = first:copy("arm" .. i, pose)
  end
  local bend, twist = body:behavior("bend"), body:behavior("twist")
  -- a hanging arm leans the other way; the upper ring is half a wave behind the lower one
  bend.offset = 2 * math.pi * place / kArms + (up and 0 or math.pi) - math.pi
  twist.offset = bend.offset
  arms[i] = { body = body, bend = bend, twist = twist, gust = 0 }
end

-- behaviors of all tips together
local function gather(type, name, opts)
  opts.active, opts.bodies, opts.parts = false, "arm*", "tip"
  sim:add_group_behavior(type, name, opts)
end
gather("cohesion", "cohesion", {})
gather("cohesion", "evasion", { amount = -1 })
gather("alignment", "alignment", {})

-- a slider that was moved sets all arms; otherwise values set on single arms stay
state.applied = state.applied or {}
local function apply(name, value, twist)
  if state.applied[name] == value then return end
  state.applied[name] = value
  for _, arm in ipairs(arms) do arm.bend[name], arm.twist[name] = value, value * twist end
end

sim:on_step(function(dt)
  apply("rate", params.rate, 0.5)
  apply("depth", params.depth, 0.6)
  apply("lag", params.lag, 0.6)
  for _, arm in ipairs(arms) do
    if arm.gust > 0 then
      arm.gust = arm.gust > 0.01 and arm.gust * math.exp(-dt / 1.5) or 0
      arm.bend.depth = math.min(params.depth * (1 + arm.gust), 1.3)
    end
  end
end)

osc:on("/sway", function(strength, name)
  for _, arm in ipairs(arms) do
    if name == nil or arm.body.name == name then arm.gust = math.min(arm.gust + (strength or 1), 2) end
  end
end)
