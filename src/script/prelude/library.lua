-- Replaces functions of Lua's libraries for which some release of LuaJIT compiles code that gives other results than
-- the interpreter. Since a loop is interpreted at first and compiled later, results would depend on that moment.
--   math.min, math.max   NaN and -0                      2.1.0-beta3 (Debian 12)
--   math.ceil            -0                              2.1.0-beta3 of 2022 (Debian 12)
--   string.sub           positions outside of the text   all; 2.1.1737090214 (Debian 13) also crashes
--   bit.*                fractions and large numbers     arm64
local P = ...
local api, fail, describe = P.api, P.fail, P.describe
local native_sub, native_byte = string.sub, string.byte
P.native_sub = native_sub  -- for code that is never compiled

-- Compares two numbers in C like standard Lua: the first one wins a tie, and NaN loses.
local function replace_extreme(name, choose)
  local function want(value)
    local number = tonumber(value)
    if not number then fail("math.%s takes numbers, not %s", name, describe(value)) end
    return number
  end
  math[name] = function(x, y, ...)
    if type(x) ~= "number" then x = want(x) end
    if type(y) ~= "number" then
      if y == nil and select("#", ...) == 0 then return x end
      y = want(y)
    end
    local result = choose(x, y)
    for i = 1, select("#", ...) do result = choose(result, want((select(i, ...)))) end
    return result
  end
end
replace_extreme("min", api.min)
replace_extreme("max", api.max)

-- -0 between -1 and 0, like the C library
local floor = math.floor
function math.ceil(x)
  if type(x) ~= "number" then
    local number = tonumber(x)
    if not number then fail("math.ceil takes a number, not %s", describe(x)) end
    x = number
  end
  return -floor(-x)
end

-- first and last position of a substring of a text of n bytes, between 1 and n unless the substring is empty
local function bounds(n, first, last)
  if first < 0 then first = n + first + 1 end
  if not (first >= 1) then first = 1 end
  if last < 0 then last = n + last + 1 end
  if last > n then last = n end
  return first, last
end

local function check_text(value, name)
  if type(value) == "string" then return value end
  if type(value) == "number" then return tostring(value) end
  fail("string.%s takes text, not %s", name, describe(value))
end
-- an integer; NaN becomes 0
local function check_position(value, missing, name)
  if value == nil then return missing end
  local number = tonumber(value)
  if not number then fail("string.%s takes a number there, not %s", name, describe(value)) end
  if number ~= number then return 0 end
  return number < 0 and -math.floor(-number) or math.floor(number)
end

function string.sub(text, first, last)
  text = check_text(text, "sub")
  if first == nil then fail("string.sub takes a text and its first position") end
  first, last = bounds(#text, check_position(first, 1, "sub"), check_position(last, -1, "sub"))
  if not (first <= last) then return "" end
  return native_sub(text, first, last)
end

function string.byte(text, first, last)
  text = check_text(text, "byte")
  first = check_position(first, 1, "byte")
  first, last = bounds(#text, first, check_position(last, first, "byte"))
  if not (first <= last) then return end
  return native_byte(text, first, last)
end

-- x64 rounds to the nearest integer modulo 2^32; adding and subtracting kShift rounds in the same way
if jit.arch ~= "x64" then
  local kShift = 2 ^ 52 + 2 ^ 51
  local function whole(x) return (x + kShift - kShift) % 2 ^ 32 end
  for name, f in pairs(bit) do
    bit[name] = function(x, ...)
      if select("#", ...) == 0 then return f(type(x) == "number" and whole(x) or x) end
      local list = { x, ... }
      for i = 1, #list do
        if type(list[i]) == "number" then list[i] = whole(list[i]) end
      end
      return f(unpack(list))
    end
  end
end
