-- Lights: four moving heads follow the weights of two pendulums, and two lamps glow with their speed. Ctrl+L arms the
-- output to real lights; until then nothing is sent. docs/howto/lighting.md explains the rest.

params {
  { "follow", true, doc = "The moving heads follow the pendulums; else they shine straight down." },
  { "hue", 0.6, min = 0, max = 1, doc = "Hue of the moving heads." },
  { "brightness", 0.8, min = 0, max = 1, doc = "Brightness of the moving heads." },
}

visuals.look.lamp, visuals.look.ambient, visuals.look.rim = 0.35, 0.5, 0.5
visuals.camera:look_at(vec3(0, -9, 2.2), vec3(0, 0, 1.9))

sim:add_plane_shape("floor", vec3(0, 0, 1))
local floor = sim:add_body("floor")
floor:add_part("floor", "floor", { mass = 0 })
local ball, rod = sim:add_sphere_shape("ball", 0.12), sim:add_capsule_shape("rod", 0.025, 0.8)

-- two pendulums of two rods each, which start in opposite directions
local pendulums = {}
for i, side in ipairs { -1, 1 } do
  local body = sim:add_body("pendulum_" .. i, { self_collision = false })
  body:add_part("hook", ball, { mass = 0, position = vec3(1.3 * side, 0, 3) })
  body:add_part("upper", rod, { mass = 0.5, position = vec3(1.3 * side, 0, 2.6) })
  body:add_part("lower", rod, { mass = 0.5, position = vec3(1.3 * side, 0, 1.8) })
  body:add_part("weight", ball, { mass = 3, position = vec3(1.3 * side, 0, 1.3) })
  body:add_joint("top", "hook", "upper", { axis = vec3(0, 1, 0), position = vec3(1.3 * side, 0, 3) })
  body:add_joint("middle", "upper", "lower", { axis = vec3(0, 1, 0), position = vec3(1.3 * side, 0, 2.2) })
  body:add_joint("end", "lower", "weight", { type = "fixed" })
  pendulums[i] = body
end

-- a moving head at each corner of a truss; both at one side follow the same weight
local heads = {}
for i, x in ipairs { -3, -1, 1, 3 } do
  heads[i] = sim:add_fixture("head_" .. i, {
    profile = "moving_spot", universe = 1,
    position = vec3(x, 1.5, 4), rotation = vec3(180, 0, 0),
    targets = pendulums[x < 0 and 1 or 2]:part("weight"), zoom = 12,
  })
end
local lamps = {}
for i, x in ipairs { -2.5, 2.5 } do
  lamps[i] = sim:add_fixture("lamp_" .. i, {
    profile = "rgb_par", universe = 2, position = vec3(x, 2, 0.1), rotation = vec3(0, x > 0 and -25 or 25, 0),
    color = vec3(0.05, 0.9, 1),
  })
end

local time = 0
sim:on_step(function(dt)
  time = time + dt
  for i, head in ipairs(heads) do
    head.aim = params.follow and "part" or "angles"
    head.dimmer = params.brightness
    head.color = vec3((params.hue + 0.08 * i) % 1, 0.75, 1)
  end
  for i, lamp in ipairs(lamps) do
    local weight = pendulums[i]:part("weight")
    lamp.dimmer = math.min(1, weight.linear_velocity:length() / 4)
    -- a push to the side now and then keeps it going
    weight:apply_force(vec3(4 * math.sin(2.2 * time + i), 0, 0))
  end
end)
