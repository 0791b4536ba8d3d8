-- A dancer of ball joints: 16 parts on soft springs dance on the strings of an invisible puppeteer.
-- docs/learn/study_dancer.md builds it step by step.

-- Ground and view
sim:add_body("ground"):add_part("floor", sim:add_plane_shape("floor"), { friction = 0.7 })
visuals.camera:look_at(vec3(1.3, -3.1, 1.4), vec3(0, 0, 0.9))
sim.substeps = 16 -- stiff springs on light hands need short steps

-- Colors: hue, saturation, brightness
local kDress = vec3(0.95, 0.75, 0.85)
local kSkin = vec3(0.07, 0.45, 0.95)
local kHair = vec3(0.06, 0.7, 0.25)
local kShoe = vec3(0.13, 0.8, 1)

-- Limbs: a capsule from one point to another
local dancer = sim:add_body("dancer", { self_collision = false })
local function add_limb(name, from, to, radius, mass, color)
  local way = to - from
  local shape = sim:add_capsule_shape(name, radius, way:length())
  shape.color = color
  local axis = vec3(0, 0, 1):cross(way) -- a capsule is along z; turn it to the way
  local upright = axis:length() < 1e-6
  local turn = upright and quat.euler(0, 0, 0) or quat.axis(axis, math.acos(way:normalized().z))
  return dancer:add_part(name, shape, { mass = mass, position = (from + to) / 2, rotation = turn })
end

-- Ball joints: a cone about the limb, limits of its twist, and a soft spring on each axis
local muscles = {}
local function set_strength(muscle, factor)
  local k = muscle.stiffness * factor -- N·m/rad; a limb is light about its length
  muscle.motor.angular_spring_stiffness = vec3(k, k, k / 8)
  muscle.motor.angular_spring_damping = 0.06 * vec3(k, k, k / 8)
end
local function add_ball(parent, child, position, axis, cone, twist, stiffness)
  local joint = dancer:add_joint(child, parent, child, {
    type = "spherical",
    position = position,
    axis = axis,
    cone_limit = cone,
    twist_lower = -twist,
    twist_upper = twist,
  })
  local motor = dancer:add_motor(joint, { mode = "spring", angular_spring_active = { true, true, true } })
  muscles[child] = { motor = motor, stiffness = stiffness }
  set_strength(muscles[child], 1)
end

-- Spine: pelvis, belly, chest, head; and the hand that the chest hangs from
local hips, waist, ribs, throat = vec3(0, 0, 0.96), vec3(0, 0, 1.06), vec3(0, 0, 1.22), vec3(0, 0, 1.47)
local up = vec3(0, 0, 1)
dancer:add_part("hand", sim:add_sphere_shape("hand", 0.02), { mass = 0, position = vec3(0, 0, 2.4), transparency = 1 })
add_limb("pelvis", hips - vec3(0.06, 0, 0), hips + vec3(0.06, 0, 0), 0.095, 9, kDress)
add_limb("belly", waist, ribs - vec3(0, 0, 0.04), 0.1, 6, kDress)
local chest = add_limb("chest", ribs + vec3(0, 0, 0.06), throat - vec3(0, 0, 0.1), 0.13, 12, kDress)
add_limb("head", throat + vec3(0, 0, 0.14), throat + vec3(0, -0.01, 0.2), 0.1, 4, kSkin)
add_ball("pelvis", "belly", waist, up, 0.4, 0.5, 150)
add_ball("belly", "chest", ribs, up, 0.35, 0.5, 150)
add_ball("chest", "head", throat, up, 0.6, 1.0, 20)

-- Costume: parts that are fixed to others
local function wear(parent, name, shape, position, color)
  shape.color = color
  dancer:add_part(name, shape, { mass = 0.3, position = position })
  dancer:add_joint(name, parent, name, { type = "fixed", position = position })
end
wear("pelvis", "skirt", sim:add_cone_shape("skirt", 0.35, 0.36), hips, kDress)
wear("head", "bun", sim:add_sphere_shape("bun", 0.06), throat + vec3(0, 0.07, 0.29), kHair)

-- Arms: they are built stretched out, so their cones are about that direction
for _, side in ipairs { 1, -1 } do
  local name = side == 1 and "left" or "right"
  local out = vec3(side, 0, 0)
  local shoulder = vec3(0.19 * side, 0, 1.42)
  local elbow, wrist = shoulder + 0.28 * out, shoulder + 0.53 * out
  add_limb(name .. "_arm", shoulder + 0.03 * out, elbow - 0.02 * out, 0.045, 2, kSkin)
  add_limb(name .. "_forearm", elbow + 0.02 * out, wrist - 0.03 * out, 0.036, 1.4, kSkin)
  add_limb(name .. "_hand", wrist + 0.03 * out, wrist + 0.12 * out, 0.03, 0.5, kSkin)
  add_ball("chest", name .. "_arm", shoulder, out, 1.6, 0.3, 18)
  add_ball(name .. "_arm", name .. "_forearm", elbow, out, 1.3, 0.6, 14)
  add_ball(name .. "_forearm", name .. "_hand", wrist, out, 0.9, 0.4, 3)
end

-- Legs
for _, side in ipairs { 1, -1 } do
  local name = side == 1 and "left" or "right"
  local down = vec3(0, 0, -1)
  local hip = vec3(0.1 * side, 0, 0.92)
  local knee, ankle = hip + 0.42 * down, hip + 0.83 * down
  add_limb(name .. "_thigh", hip + 0.05 * down, knee - 0.03 * down, 0.07, 7, kDress)
  add_limb(name .. "_shin", knee + 0.04 * down, ankle - 0.03 * down, 0.05, 3.5, kSkin)
  add_limb(name .. "_foot", ankle + vec3(0, 0.03, -0.03), ankle + vec3(0, -0.14, -0.05), 0.035, 1, kShoe)
  add_ball("pelvis", name .. "_thigh", hip, down, 1.3, 0.7, 45)
  add_ball(name .. "_thigh", name .. "_shin", knee, down, 1.8, 0.2, 12)
  add_ball(name .. "_shin", name .. "_foot", ankle, down, 0.7, 0.3, 3)
end

-- The skirt does not collide with the belly and the thighs inside it
for _, name in ipairs { "belly", "left_thigh", "right_thigh" } do dancer:exclude_pair("skirt", name) end

-- Sliders
params {
  { "tempo", 0.5, min = 0.1, max = 1.5, unit = "Hz", doc = "Bars per second." },
  { "vigor", 1, min = 0, max = 2, doc = "Size of all movements." },
  { "softness", 0, min = 0, max = 3, doc = "1: springs of half the stiffness; 2: of a quarter." },
  { "lift", 0, min = -0.3, max = 0.6, unit = "m", doc = "How far the puppeteer lifts the dancer." },
  { "turn", 0.15, min = -1, max = 1, unit = "Hz", doc = "Pirouettes per second." },
  { "pull", 0, min = -150, max = 150, unit = "N", doc = "A force that pulls the chest to the right." },
}

-- Puppeteer: an invisible hand holds the chest by springs, softly enough that the dancer sways
local hand = dancer:part("hand")
local string = dancer:add_motor(dancer:add_joint("string", hand, chest, { type = "floating", position = ribs }), {
  mode = "spring",
  linear_spring_active = { true, true, true },
  angular_spring_active = { true, true, true },
  linear_spring_stiffness = vec3(2000, 2000, 6000),
  linear_spring_damping = vec3(250, 250, 400),
  angular_spring_stiffness = vec3(250, 250, 150),
  angular_spring_damping = vec3(25, 25, 15),
})

-- Poses: the targets of a ball joint, rad, from three angles that every limb shares
local function aim(name, x, y, z) muscles[name].motor.angular_spring_rest_length = params.vigor * vec3(x, y, z or 0) end
local function dance(phase)
  local beat, bar = math.sin(2 * phase), math.sin(phase)
  aim("belly", 0.1 * beat, 0.25 * bar, 0.3 * math.cos(phase))
  aim("chest", -0.1 + 0.15 * math.cos(2 * phase), -0.3 * bar, -0.35 * math.cos(phase))
  aim("head", 0.15 * beat, -0.3 * bar, 0.5 * math.sin(phase + 0.6))
  for _, side in ipairs { 1, -1 } do
    local name = side == 1 and "left" or "right"
    local p = phase + (side == 1 and 0 or math.pi)
    local wave = function(lag) return math.sin(p - lag) end
    aim(name .. "_arm", -side * (0.8 + 0.9 * wave(0)), -0.3 - 0.3 * wave(1), 0.2 * wave(0.5))
    aim(name .. "_forearm", -side * (0.3 + 0.6 * wave(0.8)), -0.4, 0)
    aim(name .. "_hand", -side * 0.7 * wave(1.6), -0.2, 0)
    local kick = math.max(0, wave(0.3))
    aim(name .. "_thigh", -1.1 * kick, side * 0.25 + 0.5 * side * kick * math.max(0, beat))
    aim(name .. "_shin", 1.3 * kick, 0)
    aim(name .. "_foot", 0.5 * kick, 0)
  end
end

-- The dance
state.phase, state.heading = state.phase or 0, state.heading or 0
sim:on_step(function(dt)
  state.phase = state.phase + 2 * math.pi * params.tempo * dt
  state.heading = state.heading + 2 * math.pi * params.turn * dt
  for _, muscle in pairs(muscles) do set_strength(muscle, 2 ^ -params.softness) end
  dance(state.phase)
  local beat = math.sin(state.phase)
  local sway = params.vigor * vec3(0.15 * beat, 0, 0.05 * math.abs(beat))
  string.linear_spring_rest_length = sway + vec3(0, 0, params.lift)
  string.angular_spring_rest_length = vec3(0, 0.2 * params.vigor * beat, state.heading)
  chest:apply_force(vec3(params.pull, 0, 0))
end)
