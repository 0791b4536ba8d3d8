-- Sensors of parts, contacts of a part, rays and spheres. The events of zones are in callbacks.lua.
local P = ...
local api, ctx, answer, number, classes = P.api, P.ctx, P.answer, P.answer.number, P.classes
local fail, describe, handle_of = P.fail, P.describe, P.handle_of
local V, istype = P.V, P.ffi.istype
local sensors = 8  -- kind of list
local body, part = classes.body, classes.part
local method = P.sim_method

local function answered_part() return handle_of(answer.slot, answer.generation) end

local function related(which)
  return function(h)
    if api.related(ctx, h.slot_, h.generation_, which) ~= 0 then P.fail_removed(h) end
    return (P.answered_handle())
  end
end

for _, name in ipairs { "imu", "range_finder", "zone", "touch" } do
  local class = classes[name]
  class.kind = "sensor"
  P.derive_members(class)
  P.add_common_members(class)
  class.getters.body, class.getters.part = P.owner_of, related(0)
  if name == "range_finder" or name == "zone" then class.getters.other = related(1) end
  P.finish_class(class)
  local subject = "add_" .. name
  part.methods[subject] = function(h, key, opts)
    P.check_self(h, part, subject)
    P.check_text(key, subject .. ": the name")
    P.check_opts(class, opts, {}, subject)
    local code = api.add_sensor(ctx, h.slot_, h.generation_, name, #name, key, #key)
    return P.finish_creation(code, class, opts, {}, h)
  end
end

body.getters.sensors = function(h) return (P.list_of(h, sensors)) end
body.methods.sensor = function(h, key)
  if not istype(body.ctype, h) then P.check_self(h, body, "sensor") end
  return (P.find_in(h, sensors, key))
end

-- the contact points of a part in the last tick
part.methods.contacts = function(h)
  P.check_self(h, part, "contacts")
  local list, i = {}, 0
  while true do
    local code = api.part_contact(ctx, h.slot_, h.generation_, i)
    if code == -1 then return list end
    if code == 0 then
      list[#list + 1] = {
        part = answered_part(),
        position = V(number[0], number[1], number[2]),
        normal = V(number[3], number[4], number[5]),
        friction = V(number[6], number[7], number[8]),
        force = number[9],
        impulse = number[10],
        distance = number[11],
      }
    end
    i = i + 1
  end
end

local function check_point(value, subject)
  local v = P.check_vec3(value, subject)
  P.check_number(v.x, subject)
  P.check_number(v.y, subject)
  P.check_number(v.z, subject)
  return v
end

-- the slot and generation of the part or body that a query ignores; -1: none
local query_opts = { ignore = true }
local function ignored(opts, subject, known)
  if opts == nil then return -1, 0 end
  if type(opts) ~= "table" then fail("%s: opts is a table, not %s", subject, describe(opts)) end
  for key in pairs(opts) do
    if not known[key] then
      fail("%s: opts has no '%s'%s", subject, tostring(key), P.hint(tostring(key), P.sorted_keys(known)))
    end
  end
  local ignore = opts.ignore
  if ignore == nil then return -1, 0 end
  local class = P.class_of(ignore)
  if class ~= body and class ~= part then
    fail("%s: ignore is a body or a part, not %s", subject, describe(ignore))
  end
  P.slot_of(ignore)
  return ignore.slot_, ignore.generation_
end

method("ray", function(_, from, to, opts)
  local a, b = check_point(from, "sim:ray: from"), check_point(to, "sim:ray: to")
  local slot, generation = ignored(opts, "sim:ray", query_opts)
  if api.ray(ctx, a.x, a.y, a.z, b.x, b.y, b.z, slot, generation) ~= 0 then return nil end
  return {
    part = answered_part(),
    position = V(number[0], number[1], number[2]),
    normal = V(number[3], number[4], number[5]),
    distance = number[6],
  }
end)

local rays_opts = { ignore = true, into = true }
method("rays", function(_, from, targets, opts)
  local a = check_point(from, "sim:rays: from")
  if type(targets) ~= "table" then fail("sim:rays: targets is a list of vec3s, not %s", describe(targets)) end
  local slot, generation = ignored(opts, "sim:rays", rays_opts)
  local distances = opts and opts.into
  if distances == nil then distances = {} end
  if type(distances) ~= "table" then fail("sim:rays: into is a table, not %s", describe(distances)) end
  local count = #targets
  for i = 1, count do
    local b = targets[i]
    if not istype(V, b) or b.x - b.x ~= 0 or b.y - b.y ~= 0 or b.z - b.z ~= 0 then
      b = check_point(b, "sim:rays: target " .. i)
    end
    local hit = api.ray(ctx, a.x, a.y, a.z, b.x, b.y, b.z, slot, generation) == 0
    distances[i] = hit and number[6] or 1 / 0
  end
  for i = #distances, count + 1, -1 do distances[i] = nil end
  return distances
end)

method("overlap_sphere", function(_, center, radius, opts)
  local c = check_point(center, "sim:overlap_sphere: center")
  if P.check_number(radius, "sim:overlap_sphere: radius") < 0 then
    fail("sim:overlap_sphere: the radius must be at least 0, not %s", tostring(radius))
  end
  local slot, generation = ignored(opts, "sim:overlap_sphere", query_opts)
  local parts, distances = {}, {}
  for i = 1, api.near_parts(ctx, c.x, c.y, c.z, radius, slot, generation) do
    api.near_part(ctx, i - 1)
    parts[i], distances[i] = answered_part(), number[0]
  end
  return parts, distances
end)
