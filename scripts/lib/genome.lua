-- genome: bodies that grow from a list of numbers, for `limber evolve`. The list has one rule after the other; a rule
-- has the numbers of genome.genes: the shape of a limb, how it moves, and which rules its branches follow. The same
-- numbers give the same body.
--
--   local genome = require "genome"
--   params(genome.params(3))
--   local tree = genome.mirror(genome.grow(genome.numbers(params, 3)))
--   local body, motors = genome.build("creature", tree)
--   sim:on_step(function() genome.move(tree, motors, sim.time) end)
--
-- docs/howto/experiments.md describes it.
local genome = {}

-- The numbers of a rule. `live`: it doesn't change the shape, so the scene is not built again.
genome.genes = {
  { "length", 0.2, 0.1, 0.4, unit = "m", doc = "Length of the limb." },
  { "radius", 0.03, 0.02, 0.06, unit = "m", doc = "Radius of the limb." },
  { "place", 0.9, 0, 1, doc = "Where it grows from the limb before: 0 at its start, 1 at its end." },
  { "bend", 0.8, -1.6, 1.6, unit = "rad", doc = "Angle between it and the limb before." },
  { "turn", 1.2, -3.14, 3.14, unit = "rad", doc = "Direction of that angle, around the limb before." },
  { "swing", 0.5, 0, 1, unit = "rad", live = true, doc = "How far it swings to either side." },
  { "phase", 0.25, 0, 1, live = true, doc = "Begin of its swing, in periods." },
  { "branches", 1.5, 0, 2.99, doc = "Number of limbs that grow from it, rounded down." },
  { "first", 0.4, 0, 1, doc = "Rule of the first of them: 0 the first rule, 1 the last one." },
  { "second", 0.7, 0, 1, doc = "Rule of the second one." },
}
local COUNT = #genome.genes
local DENSITY = 400  -- kg/m³
local STRENGTH = 8   -- torque of a joint per weight of all limbs and length of its limb

-- The name of a parameter: "limb2_length" for the second rule.
local function name_of(rule, gene) return "limb" .. rule .. "_" .. gene[1] end

local live = {}  -- names of live parameters, by rule and gene
local function live_names(rule)
  if not live[rule] then
    live[rule] = {}
    for _, gene in ipairs(genome.genes) do
      if gene.live then live[rule][gene[1]] = name_of(rule, gene) end
    end
  end
  return live[rule]
end

local function check(numbers, caller)
  if type(numbers) ~= "table" or #numbers == 0 or #numbers % COUNT ~= 0 then
    error(("genome.%s: the list must have %d numbers per rule, not %s"):format(
      caller, COUNT, type(numbers) == "table" and #numbers or "a " .. type(numbers)), 3)
  end
end

-- Returns the declarations of `rules` rules, for params { … }. `numbers`: their defaults.
function genome.params(rules, numbers)
  if numbers then check(numbers, "params") end
  local list = {}
  for rule = 1, rules do
    for _, gene in ipairs(genome.genes) do
      -- later rules differ a little, so that the defaults give no two equal limbs
      local default = gene[2] + (rule - 1) * 0.1 * (gene[4] - gene[3])
      default = math.clamp(numbers and numbers[#list + 1] or default, gene[3], gene[4])
      list[#list + 1] = {
        name_of(rule, gene), default, min = gene[3], max = gene[4], unit = gene.unit, doc = gene.doc,
        rerun = not gene.live or nil,
      }
    end
  end
  return list
end

-- Returns the values of these parameters as a list.
function genome.numbers(values, rules)
  local list = {}
  for rule = 1, rules do
    for _, gene in ipairs(genome.genes) do list[#list + 1] = values[name_of(rule, gene)] end
  end
  return list
end

-- Grows a tree from a list of numbers: a list of limbs, each after the one that it grows from. The first limb follows
-- the first rule. Limbs nearer to the first one grow first, until there are `parts` (12), at most `depth` (4) after it.
-- A limb has: parent (the index of the limb that it grows from, 0 for the first), depth, rule, side (1, or -1 for a
-- mirrored limb), lag (periods by which it swings later), and the numbers of its rule by name.
function genome.grow(numbers, opts)
  check(numbers, "grow")
  local rules = #numbers / COUNT
  local parts, depth = opts and opts.parts or 12, opts and opts.depth or 4
  local tree = {}
  local function add(rule, parent, distance)
    local limb = { parent = parent, depth = distance, rule = rule, side = 1, lag = 0 }
    for i, gene in ipairs(genome.genes) do
      limb[gene[1]] = math.clamp(numbers[(rule - 1) * COUNT + i], gene[3], gene[4])
    end
    tree[#tree + 1] = limb
  end
  add(1, 0, 0)
  local at = 1
  while tree[at] do
    local limb = tree[at]
    for branch = 1, math.floor(limb.branches) do
      if #tree >= parts or limb.depth >= depth then break end
      local share = branch == 1 and limb.first or limb.second
      add(math.min(math.floor(share * rules) + 1, rules), at, limb.depth + 1)
    end
    at = at + 1
  end
  return tree
end

local function copy_of(limb)
  local copy = {}
  for key, value in pairs(limb) do copy[key] = value end
  return copy
end

-- Returns the tree without the limbs for which `keep(limb, index)` is false, and without all that grows from them.
function genome.prune(tree, keep)
  local pruned, indices = {}, { [0] = 0 }
  for i, limb in ipairs(tree) do
    local parent = indices[limb.parent]
    if parent and (i == 1 or keep(limb, i)) then
      local copy = copy_of(limb)
      copy.parent = parent
      pruned[#pruned + 1] = copy
      indices[i] = #pruned
    end
  end
  return pruned
end

-- Returns the tree with a mirrored copy of all limbs but the first: right and left. The copy swings `lag` (0.5) periods
-- later.
function genome.mirror(tree, lag)
  local both, indices = {}, { 1 }
  for i, limb in ipairs(tree) do both[i] = copy_of(limb) end
  for i = 2, #tree do
    local limb = copy_of(tree[i])
    limb.parent = indices[limb.parent]
    limb.turn = -limb.turn
    limb.side = -limb.side
    limb.lag = limb.lag + (lag or 0.5)
    both[#both + 1] = limb
    indices[i] = #both
  end
  return both
end

-- Returns a changed copy of a list of numbers: each number by a normally distributed share (0.1 of its range) of it.
function genome.mutate(numbers, amount)
  check(numbers, "mutate")
  local changed = {}
  for i, number in ipairs(numbers) do
    local gene = genome.genes[(i - 1) % COUNT + 1]
    changed[i] = math.clamp(number + (amount or 0.1) * (gene[4] - gene[3]) * rng:normal(), gene[3], gene[4])
  end
  return changed
end

-- Returns a list whose rules are each those of one of two lists of equal length.
function genome.cross(a, b)
  check(a, "cross")
  check(b, "cross")
  if #a ~= #b then error("genome.cross: both lists must have the same length", 2) end
  local child, from_a = {}, true
  for i = 1, #a do
    if (i - 1) % COUNT == 0 then from_a = rng:uniform() < 0.5 end
    child[i] = (from_a and a or b)[i]
  end
  return child
end

-- Sets start, rotation and center of each limb, in the frame of the first one, which lies along x. Returns the lowest
-- point.
local function place(tree)
  local lowest = 0
  for i, limb in ipairs(tree) do
    local parent = tree[limb.parent]
    if i == 1 then
      limb.start = vec3()
      limb.rotation = quat.axis(vec3(0, 1, 0), math.pi / 2)
    else
      limb.start = parent.start + parent.rotation * vec3(0, 0, limb.place * parent.length)
      limb.rotation = parent.rotation * quat.axis(vec3(0, 0, 1), limb.turn) * quat.axis(vec3(0, 1, 0), limb.bend)
    end
    local along = limb.rotation * vec3(0, 0, limb.length)
    limb.center = limb.start + along / 2
    lowest = math.min(lowest, limb.start.z - limb.radius, limb.start.z + along.z - limb.radius)
  end
  return lowest
end

-- Builds the tree as a body whose lowest point is 1 cm above the floor at z = 0. Each limb is a capsule; a joint and a
-- motor bend it against the limb that it grows from. Returns the body and the motors, by the index of the limb (the
-- first limb has none).
function genome.build(name, tree)
  local body = sim:add_body(name, { self_collision = false })
  local motors, mass = {}, 0
  local up = vec3(0, 0, 0.01 - place(tree))
  for i, limb in ipairs(tree) do
    limb.mass = DENSITY * math.pi * limb.radius ^ 2 * (limb.length + 4 / 3 * limb.radius)
    mass = mass + limb.mass
    body:add_part("limb" .. i, sim:add_capsule_shape(name .. ".limb" .. i, limb.radius, limb.length), {
      mass = limb.mass, friction = 0.9, position = limb.center + up, rotation = limb.rotation,
    })
  end
  for i = 2, #tree do
    local limb = tree[i]
    body:add_joint("joint" .. i, "limb" .. limb.parent, "limb" .. i, {
      position = limb.start + up, axis = limb.rotation * vec3(0, 1, 0),
      angular_lower_limit = -1.2, angular_upper_limit = 1.2,
    })
    local torque = STRENGTH * mass * limb.length
    motors[i] = body:add_motor("joint" .. i, { max_angular_force = vec3(torque, torque, torque), speed = 10 })
  end
  return body, motors
end

-- Sets the numbers that can change while the body moves, swing and phase, to those of the parameters.
function genome.tune(tree, values)
  for _, limb in ipairs(tree) do
    local names = live_names(limb.rule)
    limb.swing, limb.phase = values[names.swing], values[names.phase]
  end
end

-- Moves the motors at a time in periods. The swing begins gradually within the first period.
function genome.move(tree, motors, periods)
  local ease = math.min(periods, 1)
  for i = 2, #tree do
    local limb = tree[i]
    motors[i].target = ease * limb.swing * math.sin(2 * math.pi * (periods - limb.phase - limb.lag))
  end
end

return genome
