-- A strandbeest: Theo Jansen's walking mechanism. Twelve legs are linkages of rods; two cranks drive them, one on each
-- side, and nothing else moves them. docs/learn/study_strandbeest.md builds it step by step.
--
-- Try while it runs:   oscsend 127.0.0.1 9003 /scene/speed f -0.8
--                      oscsend 127.0.0.1 9003 /scene/turn f 0.5
--                      oscsend 127.0.0.1 9003 /push f 20

-- Sliders
params {
  { "speed", 0.4, min = -1, max = 1, unit = "Hz", doc = "Turns of the cranks per second; negative: backwards." },
  { "turn", 0, min = -1, max = 1, doc = "Share by which the left crank is slower, and the right one faster." },
}

-- Jansen's lengths: his eleven "holy numbers", and the two that place the pivot of a leg
local a, l, m = 38, 7.8, 15 -- pivot: outward and below the axis of the crank; radius of the crank
local j, b, k, c = 50, 41.5, 61.9, 39.3 -- pin to knee, knee to pivot; pin to ankle, ankle to pivot
local d, e = 40.1, 55.8 -- sides of the upper triangle, with b: pivot to hip, hip to knee
local f, g = 39.4, 36.7 -- hip to heel, heel to ankle
local h, i = 65.7, 49 -- sides of the lower triangle, with g: heel to toe, toe to ankle
local kUnit = 0.01 -- m, the unit of these numbers
local kGap = 0.15 -- m, from one pair of legs to the next
local kHeight = 0.95 -- m, of the cranks at the start
local axis = vec3(0, 1, 0) -- direction of the axes of all joints

-- Floor and view
sim.gravity = vec3(0, 0, -9.81)
sim.substeps = 14 -- its loops stay closed within 0.1 mm
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { friction = 1 })
visuals.look.style = "studio"
visuals.background = vec3(0.1, 0.12, 0.95)
visuals.camera:look_at(vec3(2, -2.6, 1.5), vec3(0, 0, kHeight))

-- Circles: the point at the distances r from p and s from q, on the left or right of the way from p to q
local function meet(p, r, q, s, side)
  local way = q - p
  local length = way:length()
  local along = (r * r - s * s + length * length) / (2 * length)
  local aside = math.sqrt(r * r - along * along) * (side == "left" and 1 or -1)
  way = way / length
  return p + along * way + aside * vec3(-way.z, 0, way.x)
end

-- Joints of a leg for an angle of its crank: x is outward, z up, and the axis of the crank is at 0
local function joints_of(angle)
  local at = { pivot = vec3(a, 0, -l), pin = m * vec3(math.cos(angle), 0, math.sin(angle)) }
  at.knee = meet(at.pin, j, at.pivot, b, "left")
  at.ankle = meet(at.pin, k, at.pivot, c, "right")
  at.hip = meet(at.pivot, d, at.knee, e, "right")
  at.heel = meet(at.hip, f, at.ankle, g, "left")
  return at
end

-- Rods: capsules between corners, the first of which is the origin. `layer` moves them along the axis, so that the rods
-- of a leg pass each other
local function add_rods(name, corners, layer)
  local shape = sim:add_compound_shape(name)
  for n = 1, #corners == 2 and 1 or #corners do
    local from, to = kUnit * corners[n], kUnit * corners[n % #corners + 1]
    local way = to - from
    local rod = sim:add_capsule_shape(name .. n, 0.011, way:length())
    shape:add_child(rod, (from + to) / 2 + layer * axis, quat.euler(0, math.atan2(way.x, way.z), 0))
  end
  return shape
end
local function triangle(name, side, r, s, layer)
  local start, last = vec3(), vec3(side, 0, 0)
  return add_rods(name, { start, last, meet(start, r, last, s, "right") }, layer)
end
local shapes = {
  upper = triangle("upper", b, d, e, 0),
  lower = triangle("lower", g, i, h, 0),
  knee_rod = add_rods("knee_rod", { vec3(), vec3(j, 0, 0) }, 0.022),
  ankle_rod = add_rods("ankle_rod", { vec3(), vec3(k, 0, 0) }, -0.022),
  pivot_rod = add_rods("pivot_rod", { vec3(), vec3(c, 0, 0) }, 0.022),
  heel_rod = add_rods("heel_rod", { vec3(), vec3(f, 0, 0) }, 0.022),
}
local masses = { upper = 0.4, lower = 0.45, knee_rod = 0.15, ankle_rod = 0.18, pivot_rod = 0.12, heel_rod = 0.12 }

-- Feet
shapes.lower:add_child(sim:add_sphere_shape("foot", 0.022), kUnit * meet(vec3(), i, vec3(g, 0, 0), h, "right"))

-- Sails: a cloth in each upper triangle
local sail = {}
for _, corner in ipairs { vec3(), vec3(b, 0, 0), meet(vec3(), d, vec3(b, 0, 0), e, "right") } do
  for _, y in ipairs { -0.002, 0.002 } do sail[#sail + 1] = kUnit * corner + y * axis end
end
shapes.upper:add_child(sim:add_convex_mesh_shape("sail", sail))

-- Frame
local beest = sim:add_body("beest", { self_collision = false })
local along_axis = quat.euler(math.pi / 2, 0, 0) -- turns a cylinder from z to the axis
local tube = sim:add_cylinder_shape("tube", 0.016, 6.6 * kGap)
local shape = sim:add_compound_shape("frame")
for _, x in ipairs { -a, 0, a } do shape:add_child(tube, kUnit * vec3(x, 0, x == 0 and 0 or -l), along_axis) end
for _, y in ipairs { -3.25, 0, 3.25 } do
  for _, side in ipairs { -1, 1 } do
    local way = kUnit * vec3(side * a, 0, -l)
    local stay = sim:add_cylinder_shape("stay" .. y .. side, 0.016, way:length())
    shape:add_child(stay, way / 2 + y * kGap * axis, quat.euler(0, math.atan2(way.x, way.z), 0))
  end
end
shape.color = vec3(0.1, 0.2, 0.9)
local frame = beest:add_part("frame", shape, { mass = 4, position = vec3(0, 0, kHeight) })

-- Cranks: three pins each, a third of a turn apart, on arms of the length m
local cranks = {}
local pin = sim:add_cylinder_shape("pin", 0.014, 0.5 * kGap)
local arm = sim:add_capsule_shape("arm", 0.014, kUnit * m)
local function pin_angle(n) return 2 * math.pi * n / 3 end
local function add_crank(name, side)
  local shape = sim:add_compound_shape(name)
  for n = 1, 3 do
    local angle, y = pin_angle(n), side * n * kGap
    local way = kUnit * m * vec3(math.cos(angle), 0, math.sin(angle))
    shape:add_child(pin, way + y * axis, along_axis)
    for _, aside in ipairs { -0.25, 0.25 } do
      local place = way / 2 + (y + aside * kGap) * axis
      shape:add_child(arm, place, quat.euler(0, math.atan2(way.x, way.z), 0))
    end
  end
  shape.color = vec3(0.55, 0.7, 0.6)
  beest:add_part(name, shape, { mass = 1.5, position = vec3(0, 0, kHeight) })
  local joint = beest:add_joint(name, frame, name, { position = vec3(0, 0, kHeight), axis = axis })
  cranks[name] = beest:add_motor(joint, { max_angular_force = 100 })
end
add_crank("left", 1)
add_crank("right", -1)

-- Legs: those at the back are turned by half a turn about the vertical
local function add_leg(name, crank, y, angle, back)
  local at = joints_of(back and math.pi - angle or angle)
  local turn = quat.euler(0, 0, back and math.pi or 0)
  local function world(joint) return vec3(0, y, kHeight) + turn * (kUnit * at[joint]) end
  local function add_rod(kind, from, to)
    local way = at[to] - at[from]
    local rotation = turn * quat.euler(0, -math.atan2(way.z, way.x), 0)
    local opts = { mass = masses[kind], position = world(from), rotation = rotation, friction = 0.5 }
    return beest:add_part(name .. "_" .. kind, shapes[kind], opts)
  end
  local function connect(joint, parent, child, type)
    beest:add_joint(child.name .. "_" .. joint, parent, child, { type = type, position = world(joint), axis = axis })
  end
  local upper, pivot_rod = add_rod("upper", "pivot", "knee"), add_rod("pivot_rod", "pivot", "ankle")
  local knee_rod, ankle_rod = add_rod("knee_rod", "knee", "pin"), add_rod("ankle_rod", "ankle", "pin")
  local heel_rod, lower = add_rod("heel_rod", "hip", "heel"), add_rod("lower", "ankle", "heel")
  connect("pivot", frame, upper)
  connect("pivot", frame, pivot_rod)
  connect("knee", upper, knee_rod)
  connect("ankle", pivot_rod, ankle_rod)
  connect("hip", upper, heel_rod)
  connect("ankle", pivot_rod, lower)
  -- these three close loops
  connect("pin", beest:part(crank), knee_rod, "spherical")
  connect("pin", beest:part(crank), ankle_rod, "spherical")
  connect("heel", lower, heel_rod, "spherical")
  local hue = (0.02 + 0.11 * math.abs(y) / (3 * kGap)) % 1
  upper.tint, lower.tint = vec3(hue, 0.85, 1), vec3(hue, 0.75, 0.85)
  for _, rod in ipairs { pivot_rod, knee_rod, ankle_rod, heel_rod } do rod.tint = vec3(0.1, 0.2, 0.9) end
end

-- Twelve legs: three pairs on each crank
for _, side in ipairs { 1, -1 } do
  local crank = side == 1 and "left" or "right"
  for n = 1, 3 do
    add_leg(crank .. "_front_" .. n, crank, side * n * kGap, pin_angle(n), false)
    add_leg(crank .. "_back_" .. n, crank, side * n * kGap, pin_angle(n), true)
  end
end

-- Walk
state.left, state.right = state.left or 0, state.right or 0
sim:on_step(function(dt)
  local angle = 2 * math.pi * params.speed * math.min(1, sim.time) * dt
  state.left, state.right = state.left + (1 - params.turn) * angle, state.right + (1 + params.turn) * angle
  cranks.left.target, cranks.right.target = state.left, state.right
end)

-- A push from the right, and a camera that goes along
osc:on("/push", function(strength) frame:apply_impulse(vec3(0, strength or 20, 0)) end)
sim:on_start(function() visuals.camera:follow(frame) end)
