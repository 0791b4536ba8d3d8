-- A batch: balls fall through rows of pins into bins; the scene prints how many are in each bin, as a line of CSV.
-- docs/learn/study_batch.md builds it step by step and runs it many times.

-- Sizes, m
local kRows = 12 -- rows of pins
local kGap = 0.13 -- from pin to pin, and the width of a bin
local kStep = 0.12 -- from row to row
local kBins = kRows + 2
local kWall = 0.6 -- height of the walls between bins
local kTop = kWall + 0.25 + kRows * kStep -- where the balls start
local kDepth = 0.1 -- from the front pane to the back pane

-- View
visuals.camera:look_at(vec3(0.6, -4.3, 1.6), vec3(0, 0, 1.1))

-- Sliders
params {
  { "bounce", 0.3, min = 0, max = 0.9, doc = "How much of its speed a ball keeps when it bounces off a pin." },
  { "tilt", 0, min = -0.2, max = 0.2, unit = "rad", doc = "How far the board leans to the right." },
}

-- Board: everything that does not move
local board = sim:add_body("board")
local kWood, kBrass = vec3(0.6, 0.3, 0.3), vec3(0.11, 0.7, 1)
local function add_piece(name, shape, position, color, rotation)
  shape.color = color
  local opts = { mass = 0, position = position, rotation = rotation, restitution = 1, friction = 0.3 }
  return board:add_part(name, shape, opts)
end
local kWidth = kBins * kGap
add_piece("floor", sim:add_box_shape("floor", vec3(kWidth, kDepth, 0.04)), vec3(0, 0, 0.02), kWood)
for i, y in ipairs { -kDepth / 2, kDepth / 2 } do
  local pane = sim:add_box_shape("pane" .. i, vec3(kWidth, 0.01, 2 * kTop))
  pane.transparency = 1
  add_piece("pane" .. i, pane, vec3(0, y * 1.1, kTop), kWood)
end
local wall = sim:add_box_shape("wall", vec3(0.01, kDepth, kWall))
for i = 0, kBins do
  add_piece("wall" .. i, wall, vec3((i - kBins / 2) * kGap, 0, kWall / 2), kWood)
end
local pin = sim:add_capsule_shape("pin", 0.02, kDepth)
for row = 1, kRows do
  for i = 0, row do
    local place = vec3((i - row / 2) * kGap, 0, kTop - 0.1 - row * kStep)
    add_piece("pin" .. row .. "_" .. i, pin, place, kBrass, quat.euler(math.pi / 2, 0, 0))
  end
end

-- Balls: one every 0.1 s, until there are 100
local kBalls = 100
local shapes = {}
for i = 1, 12 do
  shapes[i] = sim:add_sphere_shape("ball" .. i, 0.03)
  local color = vec3(i / 12, 0.75, 1)
  shapes[i].color = color
end
state.balls = state.balls or 0
sim:every(0.1, function()
  if state.balls == kBalls then return end
  state.balls = state.balls + 1
  sim:add_body("ball" .. state.balls):add_part("ball", shapes[state.balls % 12 + 1], {
    mass = 0.02,
    friction = 0.2,
    restitution = params.bounce,
    position = vec3(rng:uniform(-0.02, 0.02), 0, kTop),
  })
end)

-- Tilt: gravity leans instead of the board
sim:on_step(function()
  sim.gravity = vec3(9.81 * math.sin(params.tilt), 0, -9.81 * math.cos(params.tilt))
end)

-- Result
local function count()
  local bins = {}
  for i = 1, kBins do bins[i] = 0 end
  for ball in sim:bodies("ball*") do
    local bin = math.floor(ball.position.x / kGap + kBins / 2) + 1
    if bins[bin] and ball.position.z < kWall then bins[bin] = bins[bin] + 1 end
  end
  return bins
end
sim:at(15, function() print(sim.seed .. "," .. params.tilt .. "," .. table.concat(count(), ",")) end)
