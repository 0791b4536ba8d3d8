-- Tendons of bodies.
local P = ...
local api, ctx, answer, number, classes = P.api, P.ctx, P.answer, P.answer.number, P.classes
local fail, describe, handle_of = P.fail, P.describe, P.handle_of
local V, ffi, istype = P.V, P.ffi, P.ffi.istype
local tendons, parts = 9, 1  -- kinds of lists
local body, part, tendon = classes.body, classes.part, classes.tendon

P.derive_members(tendon)
P.add_common_members(tendon)
tendon.getters.body = P.owner_of
tendon.getters.points = function(h)
  P.slot_of(h)
  local list = {}
  while true do
    local code = api.tendon_point(ctx, h.slot_, h.generation_, #list)
    if code ~= 0 then return list end
    list[#list + 1] = {
      part = handle_of(answer.slot, answer.generation),
      position = V(number[0], number[1], number[2]),
    }
  end
end
P.finish_class(tendon)

-- the part of a point: a handle, or the name or number of a part of the body
local function part_of(h, value, subject)
  if type(value) == "string" or type(value) == "number" then return (P.find_in(h, parts, value)) end
  if P.class_of(value) ~= part then
    fail("%s: its part is a part, or the name of one of the body, not %s", subject, describe(value))
  end
  P.slot_of(value)
  return value
end

local function write_point(h, point, subject, out)
  if type(point) ~= "table" then fail("%s is a list {part, x, y, z}, not %s", subject, describe(point)) end
  local of = part_of(h, point[1] == nil and point.part or point[1], subject)
  local x, y, z = point[2], point[3], point[4]
  if x == nil then x = point.position end
  if istype(V, x) then x, y, z = x.x, x.y, x.z end
  out[0], out[1] = of.slot_, of.generation_
  out[2] = P.check_number(x or 0, subject .. ": x")
  out[3] = P.check_number(y or 0, subject .. ": y")
  out[4] = P.check_number(z or 0, subject .. ": z")
end

local own = { points = true }
body.methods.add_tendon = function(h, key, opts)
  P.check_self(h, body, "add_tendon")
  P.check_text(key, "add_tendon: the name")
  P.check_opts(tendon, opts, own, "add_tendon")
  local points = opts and opts.points
  if type(points) ~= "table" then
    fail("add_tendon: points is a list of points {part, x, y, z}, not %s", describe(points))
  end
  local count = #points
  local numbers = ffi.new("double[?]", 5 * math.max(count, 1))
  for i = 1, count do write_point(h, points[i], "add_tendon: point " .. i, numbers + 5 * (i - 1)) end
  local code = api.add_tendon(ctx, h.slot_, h.generation_, key, #key, numbers, count)
  return P.finish_creation(code, tendon, opts, own, h)
end

body.getters.tendons = function(h) return (P.list_of(h, tendons)) end
body.methods.tendon = function(h, key)
  if not istype(body.ctype, h) then P.check_self(h, body, "tendon") end
  return (P.find_in(h, tendons, key))
end
