-- Immutable values: vec3, quat, and the three booleans of a flags property.
-- In this and the following files, functions that may be called in loops over many parts return (f(x)) in parentheses:
-- LuaJIT's compiler counts a tail call as a loop iteration and aborts a trace after fifteen. Without the parentheses
-- the behavior lua_rotation_target ran interpreted and exceeded its time budget; lua_alignment took more than twice as
-- long.
local P = ...
local ffi, fail, describe = P.ffi, P.fail, P.describe
local istype, format, sqrt = ffi.istype, string.format, math.sqrt

local V, Q, F = ffi.typeof("vec3"), ffi.typeof("quat"), ffi.typeof("flags3")
P.V, P.Q, P.F = V, Q, F

-- the argument as a vec3: a vec3, or a table of three numbers; else nil
local function as_vec3(v)
  if istype(V, v) then return v end
  if type(v) == "table" and #v == 3 then
    local x, y, z = v[1], v[2], v[3]
    if type(x) == "number" and type(y) == "number" and type(z) == "number" then return (V(x, y, z)) end
  end
end
P.as_vec3 = as_vec3

local function check_vec3(v, subject)
  if istype(V, v) then return v end
  return as_vec3(v) or fail("%s takes a vec3, not %s", subject, describe(v))
end
P.check_vec3 = check_vec3

local function check_quat(q, subject)
  if istype(Q, q) then return q end
  fail("%s takes a quat, not %s", subject, describe(q))
end
P.check_quat = check_quat

local function unknown_member(kind, methods)
  return function(_, key)
    local names = P.sorted_keys(methods)
    fail("a %s has no member '%s'%s", kind, tostring(key), P.hint(key, names))
  end
end

local function never_changes(kind)
  return function() fail("a %s is immutable; assign the whole value", kind) end
end

local function no_call(kind)
  return function() fail("this is a %s, not a function: use a dot for members, a colon only for methods", kind) end
end

local function operands(a, b, verb)
  local u, v = as_vec3(a), as_vec3(b)
  if not (u and v) then fail("can't %s %s and %s", verb, describe(a), describe(b)) end
  return u, v
end

local function length(v) return (sqrt(v.x * v.x + v.y * v.y + v.z * v.z)) end
local function cross(a, b) return (V(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)) end

-- members of value types by type name, for completion and listings
P.value_members = {
  vec3 = { x = 1, y = 1, z = 1, length = 1, normalized = 1, dot = 1, cross = 1, lerp = 1 },
  quat = { x = 1, y = 1, z = 1, w = 1, inverse = 1, slerp = 1 },
}

local vec3_methods = {}
function vec3_methods.length(v) return (length(check_vec3(v, "vec3:length"))) end
function vec3_methods.normalized(v)
  v = check_vec3(v, "vec3:normalized")
  local n = length(v)
  if n > 0 then return (V(v.x / n, v.y / n, v.z / n)) end
  return (V(0, 0, 0))
end
function vec3_methods.dot(a, b)
  a, b = check_vec3(a, "vec3:dot"), check_vec3(b, "vec3:dot")
  return a.x * b.x + a.y * b.y + a.z * b.z
end
function vec3_methods.cross(a, b) return (cross(check_vec3(a, "vec3:cross"), check_vec3(b, "vec3:cross"))) end
function vec3_methods.lerp(a, b, t)
  a, b, t = check_vec3(a, "vec3:lerp"), check_vec3(b, "vec3:lerp"), P.check_number(t, "vec3:lerp")
  return (V(a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t))
end
setmetatable(vec3_methods, { __index = unknown_member("vec3", P.value_members.vec3) })

ffi.metatype(V, {
  __index = vec3_methods,
  __newindex = never_changes("vec3"),
  __call = no_call("vec3"),
  __add = function(a, b)
    if not (istype(V, a) and istype(V, b)) then a, b = operands(a, b, "add") end
    return (V(a.x + b.x, a.y + b.y, a.z + b.z))
  end,
  __sub = function(a, b)
    if not (istype(V, a) and istype(V, b)) then a, b = operands(a, b, "subtract") end
    return (V(a.x - b.x, a.y - b.y, a.z - b.z))
  end,
  __mul = function(a, b)
    if type(b) == "number" then return (V(a.x * b, a.y * b, a.z * b)) end
    if type(a) == "number" then return (V(a * b.x, a * b.y, a * b.z)) end
    if not (istype(V, a) and istype(V, b)) then a, b = operands(a, b, "multiply") end
    return (V(a.x * b.x, a.y * b.y, a.z * b.z))
  end,
  __div = function(a, b)
    if type(b) == "number" and istype(V, a) then return (V(a.x / b, a.y / b, a.z / b)) end
    if not (istype(V, a) and istype(V, b)) then a, b = operands(a, b, "divide") end
    return (V(a.x / b.x, a.y / b.y, a.z / b.z))
  end,
  __unm = function(a) return (V(-a.x, -a.y, -a.z)) end,
  __eq = function(a, b)
    return istype(V, a) and istype(V, b) and a.x == b.x and a.y == b.y and a.z == b.z
  end,
  __tostring = function(v) return format("vec3(%.14g, %.14g, %.14g)", v.x, v.y, v.z) end,
})

function P.vec3(x, y, z)
  if type(x) == "table" and y == nil and z == nil then return check_vec3(x, "vec3") end
  if (x and type(x) ~= "number") or (y and type(y) ~= "number") or (z and type(z) ~= "number") then
    fail("vec3 takes three numbers, not %s, %s, %s", describe(x), describe(y), describe(z))
  end
  return (V(x or 0, y or 0, z or 0))
end

local function rotate(q, v)
  -- v + 2w(u × v) + 2u × (u × v), for a unit quaternion
  local tx, ty, tz = 2 * (q.y * v.z - q.z * v.y), 2 * (q.z * v.x - q.x * v.z), 2 * (q.x * v.y - q.y * v.x)
  return V(v.x + q.w * tx + q.y * tz - q.z * ty, v.y + q.w * ty + q.z * tx - q.x * tz,
    v.z + q.w * tz + q.x * ty - q.y * tx)
end

local quat_methods = {}
function quat_methods.inverse(q)
  q = check_quat(q, "quat:inverse")
  local n = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w
  if n == 0 then fail("quat(0, 0, 0, 0) is not a rotation and has no inverse") end
  return (Q(-q.x / n, -q.y / n, -q.z / n, q.w / n))
end
function quat_methods.slerp(a, b, t)
  a, b, t = check_quat(a, "quat:slerp"), check_quat(b, "quat:slerp"), P.check_number(t, "quat:slerp")
  local cosine = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w
  local sign = cosine < 0 and -1 or 1
  local p, s = 1 - t, t
  if cosine * sign < 0.9999999 then
    local angle = math.acos(cosine * sign)
    p, s = math.sin((1 - t) * angle) / math.sin(angle), math.sin(t * angle) / math.sin(angle)
  end
  s = s * sign
  local x, y, z, w = p * a.x + s * b.x, p * a.y + s * b.y, p * a.z + s * b.z, p * a.w + s * b.w
  local n = sqrt(x * x + y * y + z * z + w * w)
  return (Q(x / n, y / n, z / n, w / n))
end
setmetatable(quat_methods, { __index = unknown_member("quat", P.value_members.quat) })

local function multiply(p, q)
  return Q(p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y, p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x,
    p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w, p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z)
end

ffi.metatype(Q, {
  __index = quat_methods,
  __newindex = never_changes("quat"),
  __call = no_call("quat"),
  __mul = function(a, b)
    if istype(Q, a) then
      if istype(Q, b) then return (multiply(a, b)) end
      local v = as_vec3(b)
      if v then return (rotate(a, v)) end
    end
    fail("can't multiply %s and %s; a quat rotates its right operand", describe(a), describe(b))
  end,
  __eq = function(a, b)
    return istype(Q, a) and istype(Q, b) and a.x == b.x and a.y == b.y and a.z == b.z and a.w == b.w
  end,
  __tostring = function(q) return format("quat(%.14g, %.14g, %.14g, %.14g)", q.x, q.y, q.z, q.w) end,
})

local function quat(_, x, y, z, w)
  if x == nil and y == nil and z == nil and w == nil then return (Q(0, 0, 0, 1)) end
  if type(x) ~= "number" or type(y) ~= "number" or type(z) ~= "number" or type(w) ~= "number" then
    fail("quat takes four numbers x, y, z, w, or none")
  end
  return (Q(x, y, z, w))
end

local function axis(direction, angle)
  local v = check_vec3(direction, "quat.axis")
  local n, half = length(v), P.check_number(angle, "quat.axis") / 2
  if n == 0 then fail("quat.axis: the axis must not be zero") end
  local s = math.sin(half) / n
  return (Q(v.x * s, v.y * s, v.z * s, math.cos(half)))
end

local function half_angle(angle)
  angle = P.check_number(angle or 0, "quat.euler") / 2
  return math.sin(angle), math.cos(angle)
end
local function euler(x, y, z)
  local sx, cx = half_angle(x)
  local sy, cy = half_angle(y)
  local sz, cz = half_angle(z)
  return (multiply(Q(0, 0, sz, cz), multiply(Q(0, sy, 0, cy), Q(sx, 0, 0, cx))))
end

-- a separate table for each environment, so that scripts can't modify each other's
function P.make_quat()
  return setmetatable({ euler = euler, axis = axis }, { __call = quat, __metatable = "quat" })
end

ffi.metatype(F, {
  __index = function(f, i)
    if i == 1 then return f.x elseif i == 2 then return f.y elseif i == 3 then return f.z end
    if type(i) == "number" then return nil end
    fail("three booleans have the members 1, 2, 3 and x, y, z, not '%s'", tostring(i))
  end,
  __newindex = function() fail("three booleans are immutable; assign all of them: { false, false, true }") end,
  __call = no_call("set of three booleans"),
  __len = function() return 3 end,
  __eq = function(a, b) return istype(F, a) and istype(F, b) and a.x == b.x and a.y == b.y and a.z == b.z end,
  __tostring = function(f) return format("{ %s, %s, %s }", tostring(f.x), tostring(f.y), tostring(f.z)) end,
})
