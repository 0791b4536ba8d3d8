-- Draws the effect of the built-in behaviors on bodies, measured from their motion, as SVG on stdout, one picture per
-- type. docs/plots/make puts them into files.
--
-- A body of one kilogram at rest, pushed for one tick, has the velocity F·dt: so its velocity tells the force.
sim.gravity = vec3()
sim.timestep, sim.substeps = 1 / 60, 1

local kSphere = sim:add_sphere_shape("plot", 0.05)
local kInertia = 0.4 * 0.05 * 0.05 -- kg·m², of a ball of one kilogram
local plots = {} -- in the order in which they are printed

-- a ball of one kilogram, far from those of other pictures, within the ten kilometres of the world
local rows = 0
local function ball(name, position)
  local body = sim:add_body(name)
  body:add_part("ball", kSphere, { mass = 1, position = position })
  return body
end
local function row()
  rows = rows + 1
  return vec3(0, 100 * rows, 0)
end

local function plot(name, spec)
  spec.name = name
  plots[#plots + 1] = spec
  return spec
end

-- a curve with one ball for each x: `make(x, i, place)` gives the body; `read(body, x)` the value after the first tick
local function sweep(spec, label, from, to, n, make, read)
  local curve = { label = label, points = {}, bodies = {} }
  local place = row()
  for i = 1, n do
    local x = from + (to - from) * (i - 1) / (n - 1)
    curve.bodies[i] = { x = x, body = make(x, spec.name .. #spec .. "_" .. i, place + vec3(0, 0, 30 * i)), read = read }
  end
  spec[#spec + 1] = curve
end

-- a curve over time: `read()` after each tick
local function record(spec, label, read) spec[#spec + 1] = { label = label, points = {}, read = read } end

local function force(body) return body.root.linear_velocity.x / sim.timestep end

local p = plot("force", { x = "amp, N", y = "force, N" })
sweep(p, "max_amp = 2", -4, 4, 41, function(x, name, at)
  local body = ball(name, at)
  body:add_behavior("force", "push", { amp = x, max_amp = 2 })
  return body
end, force)

p = plot("torque", { x = "scale", y = "torque, N·m" })
for _, torque in ipairs { 1, 2 } do
  sweep(p, "torque = " .. torque, -1, 1, 21, function(x, name, at)
    local body = ball(name, at)
    body:add_behavior("torque", "turn", { torque = vec3(0.001 * torque, 0, 0), scale = 1000 * x })
    return body
  end, function(body) return body.root.angular_velocity.x / sim.timestep * kInertia end)
end

-- what pushes changes the velocity from tick to tick
local function change_of(part, property)
  local before = vec3()
  return function()
    local now = part[property]
    local change = (now - before) / sim.timestep
    before = now
    return change
  end
end

p = plot("random_force", { x = "time, s", y = "force along x, N" })
for _, max in ipairs { 10, 3 } do
  local body = ball("random_force" .. max, row())
  body:add_behavior("random_force", "wind", { max_amp = max, rand_interval = 500 })
  local change = change_of(body.root, "linear_velocity")
  record(p, "max_amp = " .. max, function() return change().x end)
end

p = plot("random_torque", { x = "time, s", y = "torque about x, N·m" })
for _, scale in ipairs { 1, 0.3 } do
  local body = ball("random_torque" .. scale * 10, row())
  body:add_behavior("random_torque", "twist", { scale = scale * 0.001, rand_interval = 500 })
  local change = change_of(body.root, "angular_velocity")
  record(p, "scale = " .. scale, function() return change().x * kInertia * 1000 end)
end

-- a rod on a hinge, strong and quick enough to follow
local rod = sim:add_box_shape("rod", vec3(0.4, 0.05, 0.05))
local function hinged(name)
  local body, at = sim:add_body(name), row()
  local post = body:add_part("post", kSphere, { mass = 0, position = at })
  local arm = body:add_part("arm", rod, { mass = 0.1, position = at + vec3(0.3, 0, 0) })
  local joint = body:add_joint("hinge", post, arm, { position = at, axis = vec3(0, 0, 1) })
  body:add_motor(joint, { speed = 50 })
  return body, joint
end

p = plot("rotation_target", { x = "time, s", y = "angle, rad" })
for _, speed in ipairs { 0.01, 0.02, 0.05 } do
  local body, joint = hinged("rotation_target" .. speed * 100)
  body:add_behavior("rotation_target", "turn", { target = vec3(0, 0, 1.2), speed = speed })
  record(p, "speed = " .. speed, function() return joint.value end)
end

p = plot("random_rotation_target", { x = "time, s", y = "angle, rad" })
for _, speed in ipairs { 0.02, 0.1 } do
  local body, joint = hinged("random_rotation_target" .. speed * 100)
  body:add_behavior("random_rotation_target", "turn", { min_target = vec3(0, 0, -1.2), max_target = vec3(0, 0, 1.2),
    speed = speed, rand_interval = 800 })
  record(p, "speed = " .. speed, function() return joint.value end)
end

p = plot("rotation_target_oscil", { x = "time, s", y = "angle, rad" })
for _, speed in ipairs { 0.02, 0.1 } do
  local body, joint = hinged("rotation_target_oscil" .. speed * 100)
  body:add_behavior("rotation_target_oscil", "swing", { speed = speed, oscil_interval = 800 })
  record(p, "speed = " .. speed, function() return joint.value end)
end

p = plot("speed", { x = "speed of the part, m/s", y = "force along its way, N" })
for _, amount in ipairs { 1, 2 } do
  sweep(p, "amount = " .. amount, 0, 3, 31, function(x, name, at)
    local body = ball(name, at)
    body:add_behavior("speed", "pace", { speed = 1, amount = amount })
    sim:on_start(function() body.linear_velocity = vec3(x, 0, 0) end)
    return body
  end, function(body, x) return (body.root.linear_velocity.x - x) / sim.timestep end)
end

p = plot("target_attraction", { x = "distance, m", y = "force towards the target, N" })
for _, min in ipairs { 0, 5 } do
  sweep(p, "min_amp = " .. min, 0.05, 12, 120, function(x, name, at)
    local body = ball(name, at - vec3(x, 0, 0))
    body:add_behavior("target_attraction", "pull", { target_pos = at, min_dist = 1, min_amp = min })
    return body
  end, force)
end

p = plot("volume", { x = "distance, m", y = "force apart, N" })
for _, min in ipairs { 0, 3 } do
  sweep(p, "min_amp = " .. min, 0.12, 1.2, 109, function(x, name, at)
    local body = ball(name, at)
    body:add_part("second", kSphere, { mass = 1, position = at - vec3(x, 0, 0) })
    body:add_behavior("volume", "apart", { min_amp = min })
    return body
  end, force)
end

-- group behaviors: one ball with one neighbor, which is too heavy to move
local function beside(name, at, x, other_velocity)
  local other = sim:add_body(name .. "_other")
  other:add_part("ball", kSphere, { mass = 1e6, position = at + vec3(x, 0, 0) })
  if other_velocity then sim:on_start(function() other.linear_velocity = other_velocity end) end
  return ball(name, at)
end

-- two sources of motion capture: one stays at its place, the other moves
local film = { source = "scripts/motion/dancer.bvh", unit = "cm", speed = 0, offset = vec3(0, -100, 0) }
local statue = sim:add_mocap("statue", film)
film.speed = 1
local dancer = sim:add_mocap("dancer", film)
local kHand = statue:joint("left_hand").position + film.offset
p = plot("mocap_attraction", { x = "distance from the joint, m", y = "force towards it, N" })
for _, most in ipairs { 10, 30 } do
  sweep(p, "max_force = " .. most, 0.1, 3, 59, function(x, name)
    local body = ball(name, kHand - vec3(x, 0, 0))
    body.root.collision_mask = 0
    body:add_behavior("mocap_attraction", "pull", { joint = statue:joint("left_hand").number, max_force = most })
    return body
  end, force)
end

p = plot("mocap_body", { x = "time, s", y = "height of the part, m" })
local figure = dancer:add_body("figure")
for _, name in ipairs { "left_hand", "left_foot" } do
  record(p, name, function() return figure:part(name).position.z end)
end

p = plot("mocap_target", { x = "time, s", y = "target, rad" })
for _, smoothing in ipairs { 0.05, 0.5 } do
  local body = sim:add_body("follower_" .. smoothing)
  body:add_part("base", kSphere, { mass = 0, position = vec3(0, -90, 0) })
  body:add_part("link", kSphere, { position = vec3(0.5, -90, 0) })
  local motor = body:add_motor(body:add_joint("hinge", "base", "link"))
  body:add_behavior("mocap_target", "copy", {
    source = dancer.number, joint = dancer:joint("left_forearm").number, smoothing = smoothing,
  })
  record(p, "smoothing = " .. smoothing, function() return motor.target end)
end

p = plot("cohesion", { x = "distance, m", y = "force towards the others, N" })
for _, min in ipairs { 0, 3 } do
  sweep(p, "min_dist = " .. min, 0.2, 12, 119, function(x, name, at)
    local body = beside(name, at, x)
    sim:add_group_behavior("cohesion", name, { bodies = { name, name .. "_other" }, min_dist = min })
    return body
  end, force)
end

p = plot("alignment", { x = "distance, m", y = "force for each m/s of difference, N" })
for _, min in ipairs { 0, 3 } do
  sweep(p, "min_dist = " .. min, 0.2, 12, 119, function(x, name, at)
    local body = beside(name, at, x, vec3(1, 0, 0))
    sim:add_group_behavior("alignment", name, { bodies = { name, name .. "_other" }, min_dist = min })
    return body
  end, force)
end

p = plot("separation", { x = "distance, m", y = "force away from the others, N" })
for _, max in ipairs { 1, 2 } do
  sweep(p, "max_dist = " .. max, 0.12, 2.4, 115, function(x, name, at)
    local body = beside(name, at, x)
    sim:add_group_behavior("separation", name, { bodies = { name, name .. "_other" }, max_dist = max })
    return body
  end, function(body) return -force(body) end)
end

-- the pictures
local kWidth, kHeight, kLeft, kRight, kTop, kBottom = 560, 280, 62, 150, 16, 44
local kColours = { "#0b7285", "#d9480f", "#5f3dc4" }

local function line(format, ...) print(string.format(format, ...)) end

-- a round step that parts the span into five or so
local function step_of(span)
  local step = 10 ^ math.floor(math.log10(span / 5))
  for _, factor in ipairs { 1, 2, 5, 10 } do
    if span / (step * factor) <= 6 then return step * factor end
  end
end

local function range_of(spec, axis)
  local low, high = math.huge, -math.huge
  for _, curve in ipairs(spec) do
    for _, point in ipairs(curve.points) do low, high = math.min(low, point[axis]), math.max(high, point[axis]) end
  end
  local step = step_of(high - low)
  return step * math.floor(low / step + 0.01), step * math.ceil(high / step - 0.01), step
end

local function draw(spec)
  local x0, x1, dx = range_of(spec, 1)
  local y0, y1, dy = range_of(spec, 2)
  local function px(x) return kLeft + (x - x0) / (x1 - x0) * (kWidth - kLeft - kRight) end
  local function py(y) return kHeight - kBottom - (y - y0) / (y1 - y0) * (kHeight - kTop - kBottom) end
  line("<!-- %s.svg -->", spec.name)
  line('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" font-family="sans-serif" font-size="12">', kWidth, kHeight)
  line("<title>%s: %s over %s</title>", spec.name, spec.y, spec.x)
  line('<rect width="%d" height="%d" fill="#ffffff"/>', kWidth, kHeight)
  for i = 0, math.floor((x1 - x0) / dx + 0.5) do
    local x = x0 + i * dx
    line('<path d="M%.1f %.1fV%.1f" stroke="#dee2e6"/>', px(x), py(y0), py(y1))
    line('<text x="%.1f" y="%.1f" text-anchor="middle">%.3g</text>', px(x), py(y0) + 16, math.abs(x) < dx / 1000 and 0 or x)
  end
  for i = 0, math.floor((y1 - y0) / dy + 0.5) do
    local y = y0 + i * dy
    line('<path d="M%.1f %.1fH%.1f" stroke="#dee2e6"/>', px(x0), py(y), px(x1))
    line('<text x="%.1f" y="%.1f" text-anchor="end">%.3g</text>', px(x0) - 6, py(y) + 4, math.abs(y) < dy / 1000 and 0 or y)
  end
  line('<text x="%.1f" y="%d" text-anchor="middle">%s</text>', (px(x0) + px(x1)) / 2, kHeight - 8, spec.x)
  line('<text transform="translate(14 %.1f) rotate(-90)" text-anchor="middle">%s</text>', (py(y0) + py(y1)) / 2, spec.y)
  for i, curve in ipairs(spec) do
    local points = {}
    for k, point in ipairs(curve.points) do points[k] = string.format("%.1f,%.1f", px(point[1]), py(point[2])) end
    line('<polyline fill="none" stroke="%s" stroke-width="2" points="%s"/>', kColours[i], table.concat(points, " "))
    line('<text x="%d" y="%d" fill="%s">%s</text>', kWidth - kRight + 10, kTop + 14 * i, kColours[i], curve.label)
  end
  line("</svg>")
end

local ticks = 0
sim:on_step(function()
  -- what a tick did is seen at the begin of the next
  for _, spec in ipairs(plots) do
    for _, curve in ipairs(spec) do
      if ticks == 1 and curve.bodies then
        for i, one in ipairs(curve.bodies) do
          curve.points[i] = { one.x, one.read(one.body, one.x) }
          one.body.enabled = false -- it has told what it had to tell
        end
      elseif ticks > 0 and curve.read then
        curve.points[ticks] = { ticks * sim.timestep, curve.read() }
      end
    end
  end
  ticks = ticks + 1
  if ticks == 200 then
    for _, spec in ipairs(plots) do draw(spec) end
  end
end)
