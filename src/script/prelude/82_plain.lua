-- Plain data as text and back: what `state` may hold, on its way from one Lua state to the next. Numbers, text, true and
-- false, vec3, quat, and tables of them.
local P = ...
local V, Q, istype, describe = P.V, P.Q, P.ffi.istype, P.describe
local format, sub, find = string.format, string.sub, string.find

local kDeepest = 100

-- "targets[3].x"
local function place(path, key)
  if type(key) == "string" and find(key, "^[%a_][%w_]*$") then return path .. "." .. key end
  return format(type(key) == "string" and "%s['%s']" or "%s[%s]", path, tostring(key))
end

local function refuse(path, what)
  error(format("%s %s; state holds numbers, text, true and false, vec3, quat, and tables of them", path, what), 0)
end

local function number(x) return format("%.17g;", x) end

-- each value is a letter and what belongs to it: a number ends with ;, a text begins with its length
local put
local function put_table(out, path, t, above)
  if above.n >= kDeepest then error(format("%s lies more than %d tables deep", path, kDeepest), 0) end
  if above[t] then refuse(path, "is a table inside itself") end
  if debug.getmetatable(t) then refuse(path, "is a table with a metatable") end
  for key in next, t do
    local kind = type(key)
    if kind ~= "number" and kind ~= "string" and kind ~= "boolean" then
      refuse(path, "has a key that is " .. describe(key))
    end
  end
  above[t], above.n = true, above.n + 1
  out[#out + 1] = "t"
  for key, value in P.pairs(t) do
    put(out, path, key)
    put(out, place(path, key), value, above)
  end
  out[#out + 1] = "e"
  above[t], above.n = nil, above.n - 1
end
function put(out, path, value, above)
  local kind = type(value)
  if kind == "number" then
    out[#out + 1] = "n" .. number(value)
  elseif kind == "string" then
    out[#out + 1] = "s" .. #value .. ";" .. value
  elseif kind == "boolean" then
    out[#out + 1] = value and "y" or "z"
  elseif kind == "table" then
    put_table(out, path, value, above)
  elseif istype(V, value) then
    out[#out + 1] = "v" .. number(value.x) .. number(value.y) .. number(value.z)
  elseif istype(Q, value) then
    out[#out + 1] = "q" .. number(value.x) .. number(value.y) .. number(value.z) .. number(value.w)
  else
    refuse(path, "is " .. describe(value))
  end
end

-- the text, or nothing and what can't be kept; `name` is what messages call the value
function P.plain_text(value, name)
  local out = {}
  local ok, fault = pcall(put, out, name, value, { n = 0 })
  if not ok then return nil, fault end
  return table.concat(out)
end

local words = { nan = 0 / 0, ["-nan"] = 0 / 0, inf = math.huge, ["-inf"] = -math.huge }
local function take_number(text, at)
  local stop = find(text, ";", at, true)
  local word = sub(text, at, stop - 1)
  return words[word] or tonumber(word), stop + 1
end

local take
local function take_table(text, at)
  local t, key, value = {}, nil, nil
  while sub(text, at, at) ~= "e" do
    key, at = take(text, at)
    value, at = take(text, at)
    t[key] = value
  end
  return t, at + 1
end
function take(text, at)
  local kind = sub(text, at, at)
  at = at + 1
  if kind == "t" then return take_table(text, at) end
  if kind == "y" or kind == "z" then return kind == "y", at end
  local a, b, c, d
  a, at = take_number(text, at)
  if kind == "n" then return a, at end
  if kind == "s" then return sub(text, at, at + a - 1), at + a end
  b, at = take_number(text, at)
  c, at = take_number(text, at)
  if kind == "v" then return V(a, b, c), at end
  d, at = take_number(text, at)
  return Q(a, b, c, d), at
end

-- what plain_text has written
function P.plain_value(text) return (take(text, 1)) end
