-- A flock: ninety fish swim together and flee from a shark. docs/learn/study_flock.md builds it step by step.

-- Water and view
sim.gravity = vec3(0, 0, 0) -- fish float
local kMiddle = vec3(0, 0, 1.8)
visuals.camera:look_at(vec3(0, -7, 2.6), kMiddle)
visuals.background = vec3(0.55, 0.7, 0.25) -- hue, saturation, brightness

-- One fish: a head, a tail, and a joint between them
local function add_fish(name, size, color, position, rotation)
  local function at(x, y, z) return vec3(x, y, z) * size end
  local head_shape = sim:add_convex_mesh_shape(name .. "_head", {
    at(0.12, 0, 0), at(-0.1, 0, 0), -- nose, end
    at(0, 0.03, 0), at(0, -0.03, 0), -- sides
    at(0.02, 0, 0.05), at(0.02, 0, -0.05), -- back, belly
  })
  local tail_shape = sim:add_convex_mesh_shape(name .. "_tail", {
    at(0.05, 0, 0), -- root
    at(-0.07, 0.006, 0.07), at(-0.07, -0.006, 0.07), -- upper tip
    at(-0.07, 0.006, -0.07), at(-0.07, -0.006, -0.07), -- lower tip
  })
  for _, shape in ipairs { head_shape, tail_shape } do
    shape.color = color
    shape.ambient_scale = 1
  end

  local fish = sim:add_body(name)
  local mass = size ^ 3
  fish:add_part("head", head_shape, { mass = 0.1 * mass })
  fish:add_part("tail", tail_shape, { mass = 0.01 * mass, position = at(-0.16, 0, 0) })
  fish:add_motor(fish:add_joint("tail", "head", "tail", { position = at(-0.09, 0, 0) }))
  fish:add_behavior("breathe", "beat", { rate = 2.5 / size, depth = 0.5, offset = rng:uniform(-3, 3) })
  fish:add_behavior("balance", "upright", { parts = "head", stiffness = 0.02 * mass, damping = 0.004 * mass })
  fish.position, fish.rotation = position, rotation
  return fish
end

-- The school
local kFish = 90
local school = {}
for i = 1, kFish do
  local color = vec3(rng:uniform(0.03, 0.14), 0.85, 1) -- hue from red to yellow, saturation, brightness
  local position = kMiddle + rng:uniform(vec3(-2, -2, -1), vec3(2, 2, 1))
  school[i] = add_fish("fish" .. i, 1, color, position, quat.euler(0, 0, rng:uniform(-math.pi, math.pi)))
end

-- Swimming: each fish turns its head to the direction of its motion
local swimmers = { unpack(school) }
sim:on_step(function()
  for _, fish in ipairs(swimmers) do
    local head = fish.root
    local ahead = head.rotation * vec3(1, 0, 0)
    local turn = ahead:cross(head.linear_velocity) * 0.2 - head.angular_velocity * 0.06
    head:apply_torque(turn * head.mass * 0.1)
  end
end)

-- Rules of each fish: it keeps its speed and returns to the middle
for _, fish in ipairs(school) do
  fish:add_behavior("speed", "cruise", { parts = "head", speed = 1, amount = 0.3 })
  fish:add_behavior("target_attraction", "home", { parts = "head", target_pos = kMiddle, max_amp = 0.5 })
end

-- Rules of the flock: how a fish reacts to its neighbors
local function add_rule(type, name, opts)
  opts.bodies, opts.parts = "fish*", "head"
  return sim:add_group_behavior(type, name, opts)
end
add_rule("cohesion", "together", { max_dist = 1.5, amount = 0.04 })
add_rule("alignment", "same_way", { max_dist = 1, linear_amount = 0.15, angular_amount = 0 })
add_rule("separation", "apart", { max_dist = 0.7, amount = 0.5 })

-- The shark
local shark = add_fish("shark", 4, vec3(0.58, 0.4, 0.7), kMiddle + vec3(3, 0, 0), quat.euler(0, 0, math.pi / 2))
shark:add_behavior("orbit", "hunt", { parts = "head", center = kMiddle, radius = 1.2, speed = 1.5, grip = 1 })
swimmers[#swimmers + 1] = shark
local fears = {}
for i, fish in ipairs(school) do
  local push = { parts = "head", max_dist = 1.5, min_amp = -0.6, max_amp = 0 } -- N, at the shark and at max_dist
  fears[i] = fish:add_behavior("target_attraction", "fear", push)
end
sim:on_step(function()
  for _, fear in ipairs(fears) do fear.target_pos = shark.position end
end)

-- A message
osc:on("/feed", function(x, y, z)
  for _, fish in ipairs(school) do
    fish:behavior("home").target_pos = x and vec3(x, y, z) or kMiddle
  end
end)
