-- A creature whose body is a list of numbers: how its limbs grow, and how they swing. A search finds bodies that get
-- far, one for each number of limbs and height:
--
--   limber evolve scripts/morphology.lua --maximize distance --descriptor limbs --descriptor height --generations 50
--   limber evolve --play morphology_evolve
--
-- Try while it runs:   oscsend 127.0.0.1 9003 /scene/limb1_length f 0.3

local genome = require "genome"

local RULES = 3
-- a creature that this search has found
local FOUND = {
  0.3431, 0.03765, 0.6261, -0.2167, 2.223, 0.7865, 0.2464, 2.863, 0.5565, 0.7422,
  0.3068, 0.04001, 0.2187, 0.985, -1.554, 0.7831, 0.604, 0.5449, 0.8446, 0.7376,
  0.3617, 0.05861, 0.8156, -0.9722, -2.425, 0.8372, 0.1364, 0.1708, 0.8567, 0.2693,
}
local declared = genome.params(RULES, FOUND)
declared[#declared + 1] = { "rate", 1.5, min = 0.5, max = 2, unit = "Hz", doc = "Swings per second." }
params(declared)

sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { friction = 1 })

local tree = genome.grow(genome.numbers(params, RULES), { parts = 7, depth = 3 })
-- no limb grows along the trunk
tree = genome.prune(tree, function(limb) return limb.depth > 1 or math.abs(limb.bend) > 0.2 end)
tree = genome.mirror(tree)
local creature, motors = genome.build("creature", tree)
local trunk = creature.root
visuals.camera.distance = 3
sim:on_start(function() visuals.camera:follow(creature) end)

-- it begins where it has come to rest
local START = 2  -- s
state.height, state.samples = state.height or 0, state.samples or 0

sim:on_step(function()
  if sim.time < START then return end
  if not state.origin then state.origin = { trunk.position.x, trunk.position.y } end
  genome.tune(tree, params)
  genome.move(tree, motors, params.rate * (sim.time - START))
  state.height, state.samples = state.height + trunk.position.z, state.samples + 1
end)

result("distance", function()
  local origin = state.origin or { trunk.position.x, trunk.position.y }
  return vec3(trunk.position.x - origin[1], trunk.position.y - origin[2], 0):length()
end)
result("limbs", function() return #tree end, { min = 1, max = 14, cells = 7 })
result("height", function() return state.height / math.max(state.samples, 1) end, { min = 0, max = 0.5, cells = 5 })
