-- A tentacle: fourteen discs on ball joints, bent by three tendons along its whole length and three up to its middle.
-- It grows out of the floor, and sways, curls and reaches by nothing but the tensions of its tendons.
--
-- Try while it runs:   oscsend 127.0.0.1 9003 /scene/lag f 0
--                      oscsend 127.0.0.1 9003 /grip f 1
--                      oscsend 127.0.0.1 9003 /scene/strength f 0
--                      oscsend 127.0.0.1 9003 /physics/body/tentacle/tendon/long_1/tension f 25

params {
  { "strength", 13, min = 0, max = 60, unit = "N", doc = "Largest tension of the pattern; 0: none." },
  { "rate", 0.12, min = 0, max = 1, unit = "Hz", doc = "How often the bend goes around." },
  { "lag", 2.4, min = -3.14, max = 3.14, unit = "rad", doc = "Angle from the lower bend to the upper one." },
}

-- Sizes
local kDiscs, kSpacing = 14, 0.13 -- number, and distance in m
local kBase, kTip = 0.17, 0.045 -- m, radius of the first and of the last disc
local function radius_of(i) return kBase + (kTip - kBase) * (i / kDiscs) ^ 0.8 end
local function height_of(i) return 0.06 + kSpacing * i end

-- Floor and view
sim.gravity = vec3(0, 0, -9.81)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
visuals.camera:look_at(vec3(1.75, -2.1, 1.3), vec3(0, 0, 0.7))

-- Discs, each with a piece of the spine
local body = sim:add_body("tentacle", { self_collision = false })
for i = 0, kDiscs do
  local radius = radius_of(i)
  local disc = sim:add_cylinder_shape("disc_" .. i, radius, 0.028)
  local spine = sim:add_capsule_shape("spine_" .. i, 0.28 * radius + 0.01, 0.5 * kSpacing)
  local shape = sim:add_compound_shape("segment_" .. i)
  shape:add_child(disc)
  shape:add_child(spine, vec3(0, 0, 0.25 * kSpacing))
  shape.color = vec3(0.47 + 0.18 * i / kDiscs, 0.7, 0.72)
  local mass = i == 0 and 0 or 0.1 * (radius / kBase) ^ 2
  body:add_part("disc_" .. i, shape, { mass = mass, position = vec3(0, 0, height_of(i)) })
end

-- Ball joints that bend by up to half a radian, and don't twist
for i = 1, kDiscs do
  local joint = body:add_joint("joint_" .. i, "disc_" .. i - 1, "disc_" .. i,
    { type = "spherical", position = vec3(0, 0, height_of(i - 0.5)) })
  joint.angular_lower_limit, joint.angular_upper_limit = vec3(-0.5, -0.5, 0), vec3(0.5, 0.5, 0)
end

-- A point near the rim of a disc, for a tendon
local function rim(i, angle, inset)
  local radius = radius_of(i) - inset
  return { "disc_" .. i, radius * math.cos(angle), radius * math.sin(angle), 0 }
end

-- Springs: three around each joint, which pull and push, straighten the spine
for i = 1, kDiscs do
  for k = 1, 3 do
    local angle = 2 * math.pi * (k + 0.25) / 3
    body:add_tendon("spring_" .. i .. "_" .. k, { points = { rim(i - 1, angle, 0.02), rim(i, angle, 0.02) },
      stiffness = 400, damping = 4, pushes = true, radius = 0.0025 })
  end
end

-- Tendons: three through the rims of all discs, three more, between them, up to the middle. They have no stiffness,
-- only the tension that is played
local function add_tendon(name, angle, last)
  local points = {}
  for i = 0, last do points[i + 1] = rim(i, angle, 0.008) end
  return body:add_tendon(name, { points = points, stiffness = 0, damping = 4, rest_length = 0, radius = 0.006 })
end
local tendons = {}
for k = 1, 3 do
  local angle = 2 * math.pi * k / 3
  tendons[#tendons + 1] = { angle = angle, long = true, tendon = add_tendon("long_" .. k, angle, kDiscs) }
  angle = angle + math.pi
  tendons[#tendons + 1] = { angle = angle, tendon = add_tendon("short_" .. k, angle, kDiscs / 2) }
end

-- The pattern: a direction of bending that goes around
state.phase, state.grip = state.phase or 0, state.grip or 0
sim:on_step(function(dt)
  state.phase = state.phase + 2 * math.pi * params.rate * dt
  state.grip = math.max(0, state.grip - 0.25 * dt)
  if params.strength == 0 then return end
  local swell = 0.62 + 0.38 * math.sin(0.61 * state.phase)
  for _, each in ipairs(tendons) do
    local direction = state.phase + (each.long and params.lag or 0)
    local pull = swell * math.max(0, math.cos(direction - each.angle))
    if each.long then pull = math.max(0.7 * pull, state.grip * (0.5 + 0.5 * math.cos(each.angle))) end
    each.tendon.tension = params.strength * (0.05 + pull)
  end
end)

-- Curls up
osc:on("/grip", function(amount) state.grip = math.clamp(amount or 1, 0, 3) end)
