-- Additions to Lua's `math`, colors, and the file's seeded random generator.
local P = ...
local ffi, api, ctx, answer, fail = P.ffi, P.api, P.ctx, P.answer, P.fail
local V, check_number, istype = P.V, P.check_number, P.ffi.istype

local extra = {}
P.math_extra = extra

function extra.clamp(x, lo, hi)
  if type(x) ~= "number" or type(lo) ~= "number" or type(hi) ~= "number" then
    fail("math.clamp takes three numbers: value, minimum, maximum")
  end
  -- Don't compare in Lua: each outcome would become a separate trace of the surrounding loop, and the compiler aborts a
  -- loop with too many traces.
  return api.clamp(x, lo, hi)
end
function extra.lerp(a, b, t) return a + (b - a) * t end
function extra.map(x, a, b, c, d) return c + (x - a) * (d - c) / (b - a) end
function extra.noise(x, y, z)
  if type(x) ~= "number" or (y and type(y) ~= "number") or (z and type(z) ~= "number") then
    fail("math.noise takes one, two or three numbers")
  end
  return api.noise(ctx, x, y or 0, z or 0)
end
-- math.random of a file: slot -1 is the scene's, -2 that of behavior file 0, and so on
function P.make_random(slot)
  return function(low, high)
    if low == nil then return api.random_uniform(ctx, slot, 0) end
    if high == nil then low, high = 1, low end
    low, high = math.floor(check_number(low, "math.random")), math.floor(check_number(high, "math.random"))
    if low > high then fail("math.random: the range %d .. %d is empty", low, high) end
    return low + math.floor(api.random_uniform(ctx, slot, 0) * (high - low + 1))
  end
end

-- red, green, blue to hue, saturation, brightness, each 0 .. 1
function P.rgb(r, g, b)
  r, g, b = check_number(r, "rgb"), check_number(g, "rgb"), check_number(b, "rgb")
  local high, low = math.max(r, g, b), math.min(r, g, b)
  local span, hue = high - low, 0
  if span > 0 then
    if high == r then hue = ((g - b) / span) % 6
    elseif high == g then hue = (b - r) / span + 2
    else hue = (r - g) / span + 4 end
  end
  return (V(hue / 6, high > 0 and span / high or 0, high))
end

local R = ffi.typeof("rng")
P.value_members.rng = { uniform = 1, direction = 1, normal = 1 }
local methods = {}
local function check(self, method)
  if not istype(R, self) then fail("rng.%s is a method: write rng:%s(…)", method, method) end
end
local function to_vec3(v)
  if type(v) == "number" then return (V(v, v, v)) end
  return P.check_vec3(v, "rng:uniform")
end
function methods.uniform(self, a, b)
  check(self, "uniform")
  if a == nil and b == nil then return api.random_uniform(ctx, self.slot_, self.generation_) end
  a, b = a or 0, b or 1
  if type(a) == "number" and type(b) == "number" then
    return a + (b - a) * api.random_uniform(ctx, self.slot_, self.generation_)
  end
  local lo, hi = to_vec3(a), to_vec3(b)
  local x = api.random_uniform(ctx, self.slot_, self.generation_)
  local y = api.random_uniform(ctx, self.slot_, self.generation_)
  local z = api.random_uniform(ctx, self.slot_, self.generation_)
  return (V(lo.x + (hi.x - lo.x) * x, lo.y + (hi.y - lo.y) * y, lo.z + (hi.z - lo.z) * z))
end
function methods.direction(self)
  check(self, "direction")
  api.random_direction(ctx, self.slot_, self.generation_)
  return (V(answer.number[0], answer.number[1], answer.number[2]))
end
function methods.normal(self)
  check(self, "normal")
  return api.random_normal(ctx, self.slot_, self.generation_)
end
setmetatable(methods, {
  __index = function(_, key)
    fail("rng has no member '%s'%s", tostring(key), P.hint(key, P.sorted_keys(P.value_members.rng)))
  end,
})
ffi.metatype(R, { __index = methods, __tostring = function() return "rng" end,
  __newindex = function() fail("rng has nothing to set") end })
P.R, P.rng = R, R(-1, 0)
