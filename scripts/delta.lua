-- A delta robot draws knots of light in the air. Three arms move a platform by six rods, which keep it level.
-- docs/learn/study_delta.md builds it step by step.
--
-- Try while it runs:   oscsend 127.0.0.1 9003 /scene/figure s rose
--                      oscsend 127.0.0.1 9003 /scene/speed f 0.6
--                      oscsend 127.0.0.1 9003 /target fff 0.2 0 0.6
-- Listen:              oscdump 9005     /pen X Y Z ERROR 20 times per second

-- Sliders
params {
  { "figure", "knot", choices = { "knot", "rose", "circle", "target" }, doc = "Path of the pen." },
  { "speed", 0.2, min = 0, max = 0.6, unit = "Hz", doc = "Figures per second." },
  { "size", 0.28, min = 0.02, max = 0.3, unit = "m", doc = "Radius of the figure." },
  { "height", 0.62, min = 0.45, max = 0.7, unit = "m", doc = "Height of the middle of the figure." },
}

-- Sizes, m
local kHeight = 1.35 -- of the axes of the arms
local kBase, kPlatform = 0.2, 0.07 -- from the middle to the axis of an arm, and to the rods
local kArm, kRod = 0.36, 0.8 -- lengths
local kPair = 0.06 -- half the distance of the two rods of an arm
local kFastest = 5 -- m/s, of the pen
local kPen = 0.1 -- length of the pen below the platform

-- View
sim.gravity = vec3(0, 0, -9.81)
visuals.camera:look_at(vec3(-0.85, -1.58, 1.3), vec3(0, 0, 0.87))

-- Inverse kinematics: the angle of an arm below the horizontal, for a place of the platform: x toward the arm, y along
-- its axis, z up from the axes. The length of the rods gives A cos(angle) + B sin(angle) = C
local function angle_of(x, y, z)
  local u = x + kPlatform - kBase
  local A, B, C = 2 * kArm * u, -2 * kArm * z, u * u + y * y + z * z + kArm * kArm - kRod * kRod
  return math.atan2(B, A) - math.acos(math.clamp(C / math.sqrt(A * A + B * B), -1, 1))
end

-- Shapes
local robot = sim:add_body("delta", { self_collision = false })
local dark, light = vec3(0.6, 0.3, 0.25), vec3(0.08, 0.85, 1)
local arm_shape = sim:add_compound_shape("arm")
arm_shape:add_child(sim:add_box_shape("beam", vec3(kArm, 0.035, 0.05)))
local axle = sim:add_cylinder_shape("axle", 0.012, 2 * kPair)
local along_y = quat.euler(math.pi / 2, 0, 0)
arm_shape:add_child(axle, vec3(kArm / 2, 0, 0), along_y)
arm_shape:add_child(sim:add_cylinder_shape("hub", 0.045, 0.1), vec3(-kArm / 2, 0, 0), along_y)
arm_shape.color = light
local rod_shape = sim:add_capsule_shape("rod", 0.009, kRod)
rod_shape.color = vec3(0, 0, 0.8)

-- Frame
local base = sim:add_compound_shape("base")
base:add_child(sim:add_cylinder_shape("plate", 0.24, 0.03), vec3(0, 0, 0.06))
for n = 0, 2 do
  local direction = math.pi / 3 + 2 * math.pi * n / 3
  local out = vec3(math.cos(direction), math.sin(direction), 0)
  local strut = sim:add_box_shape("strut" .. n, vec3(0.7, 0.036, 0.036))
  local post = sim:add_cylinder_shape("post" .. n, 0.018, kHeight + 0.06)
  base:add_child(strut, 0.45 * out + vec3(0, 0, 0.06), quat.euler(0, 0, direction))
  base:add_child(post, 0.8 * out + vec3(0, 0, 0.03 - kHeight / 2))
end
base.color = dark
robot:add_part("base", base, { mass = 0, position = vec3(0, 0, kHeight) })

-- Platform with a pen
local platform_shape = sim:add_compound_shape("platform")
platform_shape:add_child(sim:add_cylinder_shape("disc", kPlatform + 0.02, 0.02))
platform_shape:add_child(sim:add_cone_shape("pen", 0.025, kPen), vec3(0, 0, -kPen / 2), quat.euler(math.pi, 0, 0))
platform_shape.color = light
local start = vec3(0, 0, params.height + kPen)
local platform = robot:add_part("platform", platform_shape, { mass = 0.5, position = start })

-- Rods: each is a capsule with a ball joint at both ends
local function add_rod(name, arm, from, to)
  local way = to - from
  local turn = quat.axis(vec3(0, 0, 1):cross(way), math.acos(way.z / way:length()))
  robot:add_part(name, rod_shape, { mass = 0.08, position = (from + to) / 2, rotation = turn })
  robot:add_joint(name .. "_top", arm, name, { type = "spherical", position = from })
  robot:add_joint(name .. "_end", name, platform, { type = "spherical", position = to })
end

-- Arms: each turns about an axle at the base, and leads two rods
local arms = {}
for n = 1, 3 do
  local name, turn = "arm_" .. n, quat.euler(0, 0, 2 * math.pi * n / 3)
  local angle = angle_of(0, 0, start.z - kHeight)
  local hip = vec3(0, 0, kHeight) + turn * vec3(kBase, 0, 0)
  local elbow = hip + kArm * (turn * vec3(math.cos(angle), 0, -math.sin(angle)))
  local pose = { mass = 0.6, position = (hip + elbow) / 2, rotation = turn * quat.euler(0, angle, 0) }
  local arm = robot:add_part(name, arm_shape, pose)
  local joint = robot:add_joint(name, "base", arm, { position = hip, axis = turn * vec3(0, 1, 0) })
  arms[n] = { turn = turn, home = angle, motor = robot:add_motor(joint, { max_angular_force = 150 }) }
  for i, y in ipairs { kPair, -kPair } do
    add_rod("rod_" .. n .. i, arm, elbow + turn * vec3(0, y, 0), start + turn * vec3(kPlatform, y, 0))
  end
end

-- Figures: places of the pen for a phase, in units of the size
local figures = {}
function figures.knot(phase)
  local around, radius = 3 * phase, 0.68 + 0.32 * math.cos(8 * phase)
  return vec3(radius * math.cos(around), radius * math.sin(around), 0.32 * math.sin(8 * phase))
end
function figures.rose(phase)
  local around, radius = 2 * phase, math.cos(5 * phase)
  return vec3(radius * math.cos(around), radius * math.sin(around), 0.3 * math.cos(10 * phase))
end
function figures.circle(phase) return vec3(math.cos(phase), math.sin(phase), 0) end

-- Draw: a place of the figure, or the target, becomes the targets of three servos
state.phase = state.phase or 0
state.pen = state.pen or { 0, 0, params.height } -- where the pen shall be
state.target = state.target or { 0, 0, params.height }
sim:on_step(function(dt)
  state.phase = (state.phase + 2 * math.pi * params.speed * dt) % (2 * math.pi)
  local figure = figures[params.figure]
  local goal = figure and params.size * figure(state.phase) + vec3(0, 0, params.height) or vec3(unpack(state.target))
  local pen = vec3(unpack(state.pen))
  pen = pen:lerp(goal, math.min(1, kFastest * dt / math.max(1e-9, (goal - pen):length())))
  state.pen = { pen.x, pen.y, pen.z }
  for _, arm in ipairs(arms) do
    local place = arm.turn:inverse() * (pen + vec3(0, 0, kPen - kHeight))
    arm.motor.target = angle_of(place.x, place.y, place.z) - arm.home
  end
end)
osc:on("/target", function(x, y, z)
  state.target = { math.clamp(x or 0, -0.3, 0.3), math.clamp(y or 0, -0.3, 0.3), math.clamp(z or 0.6, 0.4, 0.8) }
  params.figure = "target"
end)

-- Trace: points of light that stay where the pen was
local kPoints = 300
local point = sim:add_sphere_shape("point", 0.009)
point.ambient_scale = 3
local trace, points = sim:add_body("trace"), {}
for n = 1, kPoints do
  local hidden = { mass = 0, position = vec3(0, 0, -9), collision_group = 0, collision_mask = 0 }
  points[n] = trace:add_part("point_" .. n, point, hidden)
end
sim:on_step(function()
  local next = points[1 + sim.tick % kPoints]
  next.position = platform.position - vec3(0, 0, kPen)
  next.tint = vec3(state.phase / (2 * math.pi), 0.75, 1)
end)

-- Report: where the pen is, and how far from where it shall be
sim:every(0.05, function()
  local pen = platform.position - vec3(0, 0, kPen)
  osc:send("/pen", pen.x, pen.y, pen.z, (pen - vec3(unpack(state.pen))):length())
end)
