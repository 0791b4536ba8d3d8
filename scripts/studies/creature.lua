-- A creature of one's own: a beetle of 17 parts that walks on six legs.
-- docs/learn/study_creature.md builds it step by step.

-- Ground and view
sim:add_body("ground"):add_part("floor", sim:add_plane_shape("floor"), { friction = 1 })
visuals.camera:look_at(vec3(1.1, -1.3, 0.8), vec3(0, 0, 0.2))

-- Colors: hue, saturation, brightness
local kShell = vec3(0.47, 0.85, 0.55)
local kLeg = vec3(0.08, 0.6, 0.85)
local kFeeler = vec3(0.13, 0.8, 1)

-- Limbs: a capsule from one point to another
local beetle = sim:add_body("beetle")
local function add_limb(name, from, to, radius, mass, color)
  local way = to - from
  local shape = sim:add_capsule_shape(name, radius, way:length())
  shape.color = color
  local up = vec3(0, 0, 1) -- a capsule is along z; turn it to the way
  local turn = quat.axis(up:cross(way), math.acos(way:normalized().z))
  return beetle:add_part(name, shape, { mass = mass, friction = 1, position = (from + to) / 2, rotation = turn })
end

-- Trunk
local kHeight = 0.22 -- m, of the trunk above the ground
local neck, rump = vec3(0.25, 0, kHeight), vec3(-0.25, 0, kHeight)
add_limb("trunk", rump, neck, 0.1, 2, kShell)

-- Hinges: a joint with limits, and its motor
local function add_hinge(name, parent, child, position, axis, limit)
  local joint = beetle:add_joint(name, parent, child, { position = position, axis = axis })
  joint.angular_lower_limit, joint.angular_upper_limit = -limit, limit
  return beetle:add_motor(joint, { max_angular_force = 20 })
end

-- Head and tail
add_limb("head", neck + vec3(0.1, 0, 0.03), neck + vec3(0.15, 0, 0.04), 0.09, 0.2, kShell)
add_limb("tail", rump - vec3(0.08, 0, 0), rump - vec3(0.3, 0, -0.08), 0.08, 0.2, kShell)
add_hinge("neck", "trunk", "head", neck, vec3(0, 0, 1), 0.6)
add_hinge("tail", "trunk", "tail", rump, vec3(0, 0, 1), 0.6)

-- Feelers
for _, side in ipairs { 1, -1 } do -- left and right
  local name = side == 1 and "left_feeler" or "right_feeler"
  local root = neck + vec3(0.18, 0.04 * side, 0.1)
  add_limb(name, root, root + vec3(0.15, 0.1 * side, 0.2), 0.012, 0.02, kFeeler)
  add_hinge(name, "head", name, root, vec3(0, 1, 0), 0.8)
end

-- Legs
local legs = {}
local function add_leg(name, x, side, phase)
  local hip, knee = vec3(x, 0.1 * side, kHeight), vec3(1.2 * x, 0.26 * side, kHeight + 0.06)
  local foot = vec3(1.3 * x, 0.38 * side, 0.02)
  add_limb(name .. "_thigh", hip, knee, 0.03, 0.1, kLeg)
  add_limb(name .. "_shin", knee, foot, 0.02, 0.1, kLeg)
  legs[#legs + 1] = {
    hip = add_hinge(name .. "_hip", "trunk", name .. "_thigh", hip, vec3(0, 0, -side), 0.8), -- forward
    knee = add_hinge(name .. "_knee", name .. "_thigh", name .. "_shin", knee, vec3(side, 0, 0), 1), -- up
    phase = phase,
    side = side,
  }
end
add_leg("left_front", 0.2, 1, 0)
add_leg("left_middle", 0, 1, math.pi)
add_leg("left_back", -0.2, 1, 0)
add_leg("right_front", 0.2, -1, math.pi)
add_leg("right_middle", 0, -1, 0)
add_leg("right_back", -0.2, -1, math.pi)

-- Behaviors
beetle:add_behavior("breathe", "look", { motors = "neck", rate = 0.15, depth = 0.4 })
beetle:add_behavior("breathe", "wag", { motors = "tail", rate = 0.5, depth = 0.4 })
beetle:add_behavior("random_rotation_target", "feel", {
  motors = "*_feeler",
  min_target = vec3(0, 0, -0.6),
  max_target = vec3(0, 0, 0.6),
  rand_interval = 600,
})

-- Sliders
params {
  { "pace", 1.2, min = 0, max = 3, unit = "Hz", doc = "Steps of each leg per second." },
  { "stride", 0.35, min = -0.6, max = 0.6, unit = "rad", doc = "How far the hips swing; negative: backward." },
  { "turn", 0.2, min = -1, max = 1, doc = "Shorter steps on one side: 1 turns left, -1 right." },
  { "lift", 0.5, min = 0, max = 1, unit = "rad", doc = "How high a foot is raised." },
}

-- The walk: three legs step while the other three stand
state.phase = state.phase or 0
sim:on_step(function(dt)
  state.phase = state.phase + 2 * math.pi * params.pace * dt
  for _, leg in ipairs(legs) do
    local angle = state.phase + leg.phase
    leg.hip.target = params.stride * (1 - params.turn * leg.side) * math.sin(angle)
    leg.knee.target = params.lift * math.max(0, math.cos(angle))
  end
end)

-- The camera walks along
sim:on_start(function() visuals.camera:follow(beetle) end)
