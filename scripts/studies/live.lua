-- Live coding: a floor of tiles that move up and down, and balls that dance on it. docs/learn/study_live_coding.md
-- builds it step by step while it plays.

-- View
visuals.camera:look_at(vec3(2.6, -3.6, 2.6), vec3(0, 0, 0.3))

-- Tiles: each slides up and down on its own joint
local kSide = 11 -- tiles on each side of the floor
local kTile = 0.3 -- m, from one tile to the next
local tiles = sim:add_body("tiles", { self_collision = false })
tiles:add_part("frame", sim:add_box_shape("frame", vec3(0.1, 0.1, 0.1)), { mass = 0 })
for i = 0, kSide * kSide - 1 do
  local x, y = i % kSide - (kSide - 1) / 2, math.floor(i / kSide) - (kSide - 1) / 2
  local name = "tile" .. i
  local shape = sim:add_box_shape(name, vec3(kTile - 0.02, kTile - 0.02, 0.5))
  tiles:add_part(name, shape, { mass = 1, friction = 0.3, position = vec3(kTile * x, kTile * y, 0.5) })
  tiles:add_motor(tiles:add_joint(name, "frame", name, { type = "prismatic" }))
end

-- Waves
tiles:add_behavior("ripple", "ripple")

-- Sliders
params {
  { "hue", 0.55, min = 0, max = 1, doc = "Color of the valleys." },
  { "spread", 0.35, min = -1, max = 1, doc = "Change of hue from the valleys to the crests." },
}

-- Colors: by the height of each tile
sim:on_step(function()
  for _, motor in ipairs(tiles.motors) do
    local height = math.clamp(0.5 + 2 * motor.joint.value, 0, 1)
    local color = vec3((params.hue + params.spread * height) % 1, 0.8, 0.3 + 0.7 * height)
    local shape = motor.joint.child.shape
    shape.color = color
  end
end)

-- Balls
local balls = {}
local ball_shape = sim:add_sphere_shape("ball", 0.12)
for i = 1, 6 do
  local position = vec3(0.4 * i - 1.4, 0, 1.2 + 0.2 * i)
  local opts = { mass = 0.3, restitution = 0.5, position = position }
  balls[i] = sim:add_body("ball" .. i):add_part("ball", ball_shape, opts)
end

-- Rescue: a ball that has left the floor falls onto its middle again
state.rescued = state.rescued or 0
sim:on_step(function()
  for i, ball in ipairs(balls) do
    if ball.position.z < 0.2 then
      state.rescued = state.rescued + 1
      ball.position, ball.linear_velocity = vec3(0.1 * i - 0.35, 0, 2), vec3(0, 0, 0)
    end
  end
end)

-- Drum: a message makes all balls jump
osc:on("/drum", function(strength)
  for _, ball in ipairs(balls) do ball:apply_impulse(vec3(0, 0, (strength or 3) * ball.mass)) end
end)
