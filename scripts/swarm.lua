-- A flock of a hundred small creatures, each a head with a beating tail, on a floor. OSC:
--   /swarm/scatter 2      an explosion in the middle scatters them
--   /swarm/call 1.5 0     they gather around x, y (m); without numbers they are free again
-- All other controls are parameters: with /physics/group/swarm/alignment 0, for example, the flock falls apart.

local kCreatures = 100
local kArena = 5 -- m, radius of their area

sim.gravity = vec3(0, 0, -9.81)
visuals.camera:look_at(vec3(4.5, -6.5, 3.5), vec3(0, 0, 0))

params {
  { "home", 1.5, min = 0, max = 20, unit = "m/s²", doc = "How strongly the edge of the arena turns them back." },
}

local floor = sim:add_body("floor")
floor:add_part("floor", sim:add_plane_shape("floor"), { friction = 0 }) -- they glide

-- one creature; the others are its copies
local head_shape = sim:add_sphere_shape("head", 0.06)
local tail_shape = sim:add_box_shape("tail", vec3(0.16, 0.012, 0.05))
local first = sim:add_body("bug1")
local head = first:add_part("head", head_shape, { mass = 0.1, position = vec3(0, 0, 0.06), friction = 0 })
local tail = first:add_part("tail", tail_shape, { mass = 0.01, position = vec3(-0.15, 0, 0.06), friction = 0 })
first:add_motor(first:add_joint("tail", head, tail, { position = vec3(-0.07, 0, 0.06), axis = vec3(0, 0, 1) }))
first:add_behavior("breathe", "beat", { rate = 2.5, depth = 0.5 })
first:add_behavior("balance", "upright", { parts = "head", stiffness = 0.05, damping = 0.004 })

-- sunflower pattern: evenly distributed over a disc, without overlaps, each with a random heading
local bugs = {}
for i = 1, kCreatures do
  local angle, r = i * 2.39996, 0.35 * math.sqrt(i)
  local place = {
    position = vec3(r * math.cos(angle), r * math.sin(angle), 0.06),
    rotation = quat.euler(0, 0, rng:uniform(-math.pi, math.pi)),
  }
  if i == 1 then
    first.position, first.rotation = place.position, place.rotation
    bugs[i] = first
  else
    bugs[i] = first:copy("bug" .. i, place)
  end
end

sim:add_group_behavior("flock", "swarm", { bodies = "bug*", parts = "head", radius = 1, distance = 0.35, speed = 0.8 })

-- initial velocity in the direction of the heading
sim:on_start(function()
  for _, bug in ipairs(bugs) do bug.linear_velocity = bug.rotation * vec3(0.5, 0, 0) end
end)

-- keep them in the arena; while they are called, move them there
state.called = state.called or false
sim:on_step(function()
  local middle = state.called or vec3()
  local edge = state.called and 0.5 or kArena
  for _, bug in ipairs(bugs) do
    local part = bug.root
    -- turn the heading to the direction of motion
    local ahead = part.rotation * vec3(1, 0, 0)
    part:apply_torque(vec3(0, 0, 0.01 * ahead:cross(part.linear_velocity).z - 0.003 * part.angular_velocity.z))
    local way = middle - part.center
    way = vec3(way.x, way.y, 0)
    local out = way:length() - edge
    if out > 0 then part:apply_force(way:normalized() * (params.home * math.min(out, 2) * part.mass)) end
  end
end)

osc:on("/swarm/scatter", function(strength)
  for _, bug in ipairs(bugs) do
    local away = vec3(bug.root.center.x, bug.root.center.y, 0):normalized()
    bug.root:apply_impulse(away * ((strength or 1) * bug.root.mass))
  end
end)
osc:on("/swarm/call", function(x, y)
  state.called = x and vec3(x, y or 0, 0) or false
end)
