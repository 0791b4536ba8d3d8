-- A gripper lifts things by friction alone, as hard as it must and no harder. It feels the friction on its fingers, and
-- presses in proportion to it. docs/learn/study_gripper.md builds it step by step.
--
-- Try while it runs:   oscsend 127.0.0.1 9003 /scene/safety f 0.9
--                      oscsend 127.0.0.1 9003 /scene/speed f 2
-- Listen:              oscdump 9005     /grip NORMAL_FORCE FRICTION 20 times per second

-- Sliders
params {
  { "safety", 2, min = 0.5, max = 4, doc = "Force of the fingers, as a multiple of the force that just holds." },
  { "speed", 1, min = 0.2, max = 2.5, doc = "Pace of the gantry." },
  { "belt", 0.25, min = 0, max = 0.6, unit = "m/s", doc = "Speed of the conveyor." },
  { "lift", 0.25, min = 0.12, max = 0.3, unit = "m", doc = "How high it lifts." },
}

-- Sizes, m
local kBelt = 0.3 -- height of the belt's surface
local kPick, kPlace = 0.42, -0.42 -- along the belt
local kBeam = 0.86 -- height of the beam of the gantry
local kOpen = 0.06 -- from the middle to a finger
local kFriction = 0.5 -- of a finger on a thing: the product of both values

-- View
sim.gravity = vec3(0, 0, -9.81)
visuals.look.style = "studio"
visuals.camera:look_at(vec3(0.72, -1.25, 0.8), vec3(0.01, 0, 0.49))

-- Conveyor, with rails at its sides and a stop at its end
local table_ = sim:add_body("table")
local function add_box(name, size, position, color)
  local shape = sim:add_box_shape(name, size)
  shape.color = color
  return table_:add_part(name, shape, { mass = 0, position = position })
end
local gray, dark = vec3(0.52, 0.4, 0.5), vec3(0.6, 0.2, 0.25)
local belt = add_box("belt", vec3(1.05, 0.1, 0.06), vec3(0, 0, kBelt - 0.03), dark)
for i, y in ipairs { -0.056, 0.056 } do
  add_box("rail_" .. i, vec3(1.05, 0.01, 0.05), vec3(0, y, kBelt - 0.009), gray).friction = 0.1
end
belt.surface_velocity = vec3(params.belt, 0, 0)
local stop = add_box("stop", vec3(0.02, 0.1, 0.06), vec3(kPick + 0.044, 0, kBelt + 0.02), gray)
for i, x in ipairs { -0.42, 0.42 } do
  add_box("leg_" .. i, vec3(0.06, 0.08, kBelt - 0.06), vec3(x, 0, (kBelt - 0.06) / 2), gray)
end
local arrival = stop:add_zone("arrival", { position = vec3(-0.044, 0, 0), radius = 0.02 })

-- Things: shape, mass in kg, hue
local things = {
  { sim:add_box_shape("cube", vec3(0.06, 0.06, 0.06)), 0.2, 0.13 },
  { sim:add_sphere_shape("ball", 0.033), 0.5, 0.95 },
  { sim:add_box_shape("block", vec3(0.07, 0.05, 0.07)), 1.2, 0.55 },
  { sim:add_cylinder_shape("can", 0.03, 0.08), 0.35, 0.35 },
}
for n, thing in ipairs(things) do
  local shape, mass, hue = unpack(thing)
  shape.color = vec3(hue, 0.75, 0.85)
  local body = sim:add_body(shape.name)
  thing.part = body:add_part(shape.name, shape, { mass = mass, position = vec3(0.4 - 0.17 * n, 0, kBelt + 0.041) })
  thing.part.rolling_friction = 0.002 -- the ball stays where it is put
end

-- Gantry: a carriage runs along the beam, and a column with a palm slides up and down in it
for i, x in ipairs { -0.6, 0.6 } do
  for k, y in ipairs { -0.2, 0.2 } do
    add_box("post_" .. i .. k, vec3(0.04, 0.04, kBeam + 0.02), vec3(x, y, kBeam / 2 + 0.01), gray)
  end
  add_box("cross_" .. i, vec3(0.04, 0.44, 0.04), vec3(x, 0, kBeam), gray)
end
local gantry = sim:add_body("gantry", { self_collision = false })
local white, orange = vec3(0, 0, 0.9), vec3(0.07, 0.85, 0.95)
local function add_part(name, size, mass, position, color)
  local shape = sim:add_box_shape(name, size)
  shape.color = color
  return gantry:add_part(name, shape, { mass = mass, position = position })
end
local kTop = kBelt + 0.3 -- height of the palm at the start
add_part("beam", vec3(1.24, 0.06, 0.06), 0, vec3(0, 0, kBeam), white)
add_part("carriage", vec3(0.14, 0.12, 0.14), 3, vec3(kPick, 0, kBeam), orange)
add_part("column", vec3(0.04, 0.04, 0.5), 2, vec3(kPick, 0.085, kTop + 0.24), white)
add_part("palm", vec3(0.08, 0.22, 0.03), 0.5, vec3(kPick, 0, kTop), orange)
local function add_slide(name, parent, child, axis, opts)
  local place = gantry:part(child).position
  local joint = gantry:add_joint(name, parent, child, { type = "prismatic", axis = axis, position = place })
  return gantry:add_motor(joint, opts)
end
local travel = add_slide("travel", "beam", "carriage", vec3(1, 0, 0), { max_linear_force = 500 })
local hoist = add_slide("hoist", "carriage", "column", vec3(0, 0, 1), { max_linear_force = 500 })
gantry:add_joint("wrist", "column", "palm", { type = "fixed" })

-- Fingers: one motor closes both, through a gear
local function add_finger(name, side)
  local position = vec3(kPick, side * (kOpen + 0.008), kTop - 0.08)
  local finger = add_part(name, vec3(0.04, 0.016, 0.13), 0.15, position, white)
  finger.friction, finger.report_contacts = 1, true
  local motor = add_slide(name, "palm", name, vec3(0, -side, 0), { mode = "off" })
  motor.joint.linear_lower_limit, motor.joint.linear_upper_limit = 0, kOpen
  return finger, motor
end
local left, grip = add_finger("left", 1)
local right, follower = add_finger("right", -1)
sim:add_gear(grip.joint, follower.joint, 1)
grip.mode, grip.damping = "torque", 40

-- Grip: a light touch, more in proportion to the friction that the fingers feel
local kLight, kStrongest = 3, 60 -- N, of each finger
state.force = state.force or 0
local function hold(dt)
  local friction = (left.contact_friction_force + right.contact_friction_force) / 2
  local needed = math.clamp(params.safety * friction / kFriction, kLight, kStrongest)
  state.force = math.max(needed, state.force * math.exp(-dt / 0.3)) -- tightens at once, loosens slowly
end
local function touches() return left.contact_normal_force > 0.5 and right.contact_normal_force > 0.5 end

-- Work: each step moves the palm to a height or along the belt in a time, with open or closed fingers, and names the
-- next one. The belt runs in some steps; the pace does not change the steady ones
local steps = {
  wait = { time = 0.4, belt = true, next = "reach" },
  reach = { time = 0.6, height = "low", next = "close" },
  close = { time = 0.6, closed = true, steady = true, next = "lift" },
  lift = { time = 0.9, height = "high", closed = true, next = "carry" },
  carry = { time = 1.5, x = kPlace, closed = true, belt = true, next = "lower" },
  lower = { time = 0.9, height = "low", closed = true, next = "release" },
  release = { time = 0.3, steady = true, next = "rise" },
  rise = { time = 0.5, height = "top", belt = true, next = "back" },
  back = { time = 1.2, x = kPick, belt = true, next = "wait" },
}
local kLow = kBelt + 0.165 -- of the palm: the fingers are beside a thing
local function height_of(name)
  if name == "top" then return kTop end
  return name == "low" and kLow or kLow + params.lift
end
local function begin(name) state.step, state.time, state.from = name, 0, { state.x, state.z } end
state.x, state.z = state.x or kPick, state.z or kTop
if not state.step then begin("wait") end

-- Motion: from a to b with a smooth start and end, for s from 0 to 1
local function glide(a, b, s) return a + (b - a) * s * s * s * (10 + s * (6 * s - 15)) end
sim:on_step(function(dt)
  local step = steps[state.step]
  state.time = state.time + (step.steady and 1 or params.speed) * dt
  if state.step == "wait" and arrival.count == 0 then state.time = 0 end
  local s = math.min(1, state.time / step.time)
  if step.x then state.x = glide(state.from[1], step.x, s) end
  if step.height then state.z = glide(state.from[2], height_of(step.height), s) end
  travel.target, hoist.target = state.x - kPick, state.z - kTop
  belt.surface_velocity = vec3(step.belt and params.belt or 0, 0, 0)
  if step.closed then hold(dt) else state.force = -2 end
  grip.target_torque = 2 * state.force -- both fingers share it
  if s == 1 then begin(step.closed and not touches() and "release" or step.next) end
end)

-- Colors: a finger is blue without a load, red at 15 N
sim:on_step(function()
  for _, finger in ipairs { left, right } do
    local load = math.clamp(finger.contact_normal_force / 15, 0, 1)
    finger.tint = vec3(0.6 * (1 - load), 0.9 * math.sqrt(load), 1)
  end
end)
sim:every(0.05, function() osc:send("/grip", left.contact_normal_force, left.contact_friction_force) end)

-- Rescue: a thing that fell to the floor is put back
sim:every(1, function()
  for _, thing in ipairs(things) do
    if thing.part.position.z < kBelt - 0.1 then
      thing.part.position, thing.part.rotation = vec3(kPlace, 0, kBelt + 0.06), quat()
      thing.part.linear_velocity, thing.part.angular_velocity = vec3(), vec3()
    end
  end
end)
