-- Neighbours: what the `self` of a group's member has beside that of others. A walk over them reads what the world's
-- grid found, without a call for each.
local P = ...
local ffi, api, ctx, answer, istype = P.ffi, P.api, P.ctx, P.answer, P.ffi.istype
local fail, describe, thing, alive, V = P.fail, P.describe, P.thing, P.alive, P.V

local part = P.classes.part.ctype
local W = ffi.typeof("struct { const int32_t walk_, serial_; }")
local walks = api.walks(ctx)
local kWalks = 16  -- one inside the other; as in context.h
local last = 0

-- handles of the parts that a group looks at, by the slot of its node, until the structure of the world changes
local sets = {}
local handles_of = {}  -- by walk

local function gather(h, group, version)
  local handles = {}
  for i = 0, api.neighbor_part(ctx, h.slot_, h.generation_, -1) - 1 do
    api.neighbor_part(ctx, h.slot_, h.generation_, i)
    handles[i + 1] = thing(answer.slot, answer.generation)
  end
  sets[group] = { version = version, handles = handles }
  return handles
end

local function next_neighbor(w)
  local walk = walks[w.walk_]
  if walk.serial ~= w.serial_ then fail("loops over neighbors, more than %d inside each other", kWalks) end
  local i = walk.at
  if i >= walk.count then return nil end
  walk.at = i + 1
  local n = walk.list[i]
  return handles_of[w.walk_][n.index + 1], V(n.x, n.y, n.z), n.distance
end

local function wrong_call(h, class, method, of, ...)
  if not istype(class.ctype, h) then P.check_self(h, class, method) end
  if not istype(part, of) then fail("%s: neighbors are those of a part, not of %s", P.label(h), describe(of)) end
  P.slot_of(of)
  for i = 1, select("#", ...) do
    P.want_number((select(i, ...)), select("#", ...) == 1 and method .. ": the radius" or method .. ": a distance")
  end
end

local kVelocity, kPush = 1, 2 -- of sim/neighbors.h
local told = api.means_of_all(ctx)
local group_of = P.group_of

local function ask_means(h, class, method, of, near, far, want)
  if not (istype(class.ctype, h) and istype(part, of) and type(near) == "number" and near - near == 0 and
    type(far) == "number" and far - far == 0) then
    wrong_call(h, class, method, of, near, far)
  end
  local found = api.neighbor_means(ctx, h.slot_, h.generation_, of.slot_, of.generation_, near, far, want)
  if found == nil then
    wrong_call(h, class, method, of, near, far)
    P.gone(h)
  end
  return found
end

-- what was told of all parts of the group to one who asked the same question is read where it stands
local function means(h, class, method, of, near, far, want)
  if istype(class.ctype, h) and istype(part, of) and told.least == near and told.most == far and told.want == want and
    told.group == group_of[h.number_] and alive(h) and alive(of) and of.slot_ < told.number_count then
    local number = told.numbers[of.slot_]
    if number >= 0 then return told.means[number] end
  end
  return (ask_means(h, class, method, of, near, far, want))
end

function P.neighbor_members(class)
  local ctype = class.ctype
  function class.methods.neighbors(h, of, radius)
    if not (istype(ctype, h) and istype(part, of) and type(radius) == "number" and radius - radius == 0) then
      wrong_call(h, class, "neighbors", of, radius)
    end
    last = last % kWalks + 1
    local walk = walks[last - 1]
    if api.neighbors(ctx, h.slot_, h.generation_, of.slot_, of.generation_, radius, last - 1) ~= 0 then
      wrong_call(h, class, "neighbors", of, radius)
      P.gone(h)
    end
    local set = sets[answer.slot]
    handles_of[last - 1] = set and set.version == answer.generation and set.handles or
      gather(h, answer.slot, answer.generation)
    return next_neighbor, W(last - 1, walk.serial)
  end
  function class.methods.neighbor_means(h, of, near, far)
    local m = means(h, class, "neighbor_means", of, near, far, kVelocity)
    return m.count, V(m.offset[0], m.offset[1], m.offset[2]), V(m.velocity[0], m.velocity[1], m.velocity[2]),
      V(m.spin[0], m.spin[1], m.spin[2])
  end
  function class.methods.neighbor_push(h, of, near, far)
    local m = means(h, class, "neighbor_push", of, near, far, kPush)
    return (V(m.push[0], m.push[1], m.push[2]))
  end
end

-- those of other bodies
function P.neighbor_parts(h, body)
  local group = api.neighbor_part(ctx, h.slot_, h.generation_, -2)
  local others = {}
  for _, each in ipairs(gather(h, group, api.structure(ctx))) do
    if each.body ~= body then others[#others + 1] = each end
  end
  return others
end
