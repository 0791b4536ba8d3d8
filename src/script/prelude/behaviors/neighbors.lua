-- Neighbors: additional members of `self` in groups. Iteration reads the results of the world's grid without an API
-- call for each neighbor.
local P = ...
local ffi, api, ctx, answer, istype = P.ffi, P.api, P.ctx, P.answer, P.ffi.istype
local fail, describe, handle_of, alive, V = P.fail, P.describe, P.handle_of, P.alive, P.V

local part = P.classes.part.ctype
local W = ffi.typeof("struct { const int32_t iteration_, serial_; }")
local iterations = api.iterations(ctx)
local kMaxIterations = 16  -- max. nested iterations; as in context.h
local last_iteration = 0

-- handles of the parts of a group, by the slot of its node, cached until the structure of the world changes
local sets = {}
local handles_of = {}  -- by iteration

local function gather(h, group, version)
  local handles = {}
  for i = 0, api.neighbor_part(ctx, h.slot_, h.generation_, -1) - 1 do
    api.neighbor_part(ctx, h.slot_, h.generation_, i)
    handles[i + 1] = handle_of(answer.slot, answer.generation)
  end
  sets[group] = { version = version, handles = handles }
  return handles
end

local function next_neighbor(w)
  local iteration = iterations[w.iteration_]
  if iteration.serial ~= w.serial_ then fail("loops over neighbors are nested more than %d deep", kMaxIterations) end
  local i = iteration.at
  if i >= iteration.count then return nil end
  iteration.at = i + 1
  local n = iteration.list[i]
  return handles_of[w.iteration_][n.index + 1], V(n.x, n.y, n.z), n.distance
end

local function fail_call(h, class, method, of, ...)
  if not istype(class.ctype, h) then P.check_self(h, class, method) end
  if not istype(part, of) then fail("%s: neighbors are those of a part, not of %s", P.label(h), describe(of)) end
  P.slot_of(of)
  for i = 1, select("#", ...) do
    P.check_number((select(i, ...)), select("#", ...) == 1 and method .. ": the radius" or method .. ": a distance")
  end
end

local kVelocity, kPush = 1, 2 -- as in sim/neighbors/neighbor_set.h
local group_means = api.group_means(ctx)
local group_of = P.group_of

local function query_means(h, class, method, of, near, far, want)
  if not (istype(class.ctype, h) and istype(part, of) and type(near) == "number" and near - near == 0 and
    type(far) == "number" and far - far == 0) then
    fail_call(h, class, method, of, near, far)
  end
  local found = api.neighbor_means(ctx, h.slot_, h.generation_, of.slot_, of.generation_, near, far, want)
  if found == nil then
    fail_call(h, class, method, of, near, far)
    P.fail_removed(h)
  end
  return found
end

-- if the last query had the same arguments, reads the result for all parts of the group directly
local function means(h, class, method, of, near, far, want)
  if istype(class.ctype, h) and istype(part, of) and group_means.min_distance == near and
    group_means.max_distance == far and group_means.want == want and
    group_means.group == group_of[h.number_] and alive(h) and alive(of) and
    of.slot_ < group_means.number_count then
    local number = group_means.numbers[of.slot_]
    if number >= 0 then return group_means.means[number] end
  end
  return (query_means(h, class, method, of, near, far, want))
end

function P.add_neighbor_members(class)
  local ctype = class.ctype
  function class.methods.neighbors(h, of, radius)
    if not (istype(ctype, h) and istype(part, of) and type(radius) == "number" and radius - radius == 0) then
      fail_call(h, class, "neighbors", of, radius)
    end
    last_iteration = last_iteration % kMaxIterations + 1
    local iteration = iterations[last_iteration - 1]
    if api.neighbors(ctx, h.slot_, h.generation_, of.slot_, of.generation_, radius, last_iteration - 1) ~= 0 then
      fail_call(h, class, "neighbors", of, radius)
      P.fail_removed(h)
    end
    local set = sets[answer.slot]
    handles_of[last_iteration - 1] = set and set.version == answer.generation and set.handles or
      gather(h, answer.slot, answer.generation)
    return next_neighbor, W(last_iteration - 1, iteration.serial)
  end
  function class.methods.neighbor_means(h, of, near, far)
    local m = means(h, class, "neighbor_means", of, near, far, kVelocity)
    return m.count, V(m.offset[0], m.offset[1], m.offset[2]), V(m.velocity[0], m.velocity[1], m.velocity[2]),
      V(m.angular_velocity[0], m.angular_velocity[1], m.angular_velocity[2])
  end
  function class.methods.neighbor_push(h, of, near, far)
    local m = means(h, class, "neighbor_push", of, near, far, kPush)
    return (V(m.separation[0], m.separation[1], m.separation[2]))
  end
end

-- parts of other bodies
function P.neighbor_parts(h, body)
  local group = api.neighbor_part(ctx, h.slot_, h.generation_, -2)
  local others = {}
  for _, each in ipairs(gather(h, group, api.structure(ctx))) do
    if each.body ~= body then others[#others + 1] = each end
  end
  return others
end
