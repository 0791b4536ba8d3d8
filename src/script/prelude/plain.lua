-- Serialization of plain data as text: the possible contents of `state`, passed from one Lua state to the next.
-- Numbers, text, true and false, vec3, quat, three booleans, timers, and tables of them; equal values give equal texts.
local P = ...
local ffi, V, Q, F, istype, describe = P.ffi, P.V, P.Q, P.F, P.ffi.istype, P.describe
local T = ffi.typeof("timer")
local format, byte, sub, find = string.format, string.byte, string.sub, string.find

local kMaxDepth = 100
P.plain_kinds = "state can have numbers, text, true and false, vec3, quat, timers, and tables of them"

-- numbers are stored bit by bit
local buffer = ffi.new("double[4]")
local function bytes(x, y, z, w)
  buffer[0], buffer[1], buffer[2], buffer[3] = x, y or 0, z or 0, w or 0
  return ffi.string(buffer, w and 32 or z and 24 or 8)
end

-- for example "state.targets[3].x"
local function path_of(path, key)
  if type(key) == "string" and find(key, "^[%a_][%w_]*$") then return path .. "." .. key end
  return format(type(key) == "string" and "%s['%s']" or "%s[%s]", path, tostring(key))
end

local function less(a, b) return a < b end
-- keys in a fixed order: numbers, texts, false and true; other keys can't be serialized
local function keys_of(t, path, reject)
  local keys, texts = {}, {}
  for key in next, t do
    local kind = type(key)
    if kind == "number" then keys[#keys + 1] = key
    elseif kind == "string" then texts[#texts + 1] = key
    elseif kind ~= "boolean" then reject(path, "has a key that is " .. describe(key)) end
  end
  table.sort(keys, less)
  table.sort(texts, less)
  for i = 1, #texts do keys[#keys + 1] = texts[i] end
  if t[false] ~= nil then keys[#keys + 1] = false end
  if t[true] ~= nil then keys[#keys + 1] = true end
  return keys
end

-- Each value is a letter followed by its data; a text starts with its length. Values that are not plain data are
-- reported to reject(path, reason) and omitted together with their key.
local write
local function write_table(out, path, t, reject, ancestors, depth)
  if ancestors[t] then return reject(path, "is a table that contains itself") end
  if depth > kMaxDepth then return reject(path, format("is nested more than %d tables deep", kMaxDepth)) end
  if debug.getmetatable(t) then return reject(path, "is a table with a metatable") end
  ancestors[t] = true
  out[#out + 1] = "{"
  for _, key in ipairs(keys_of(t, path, reject)) do
    local length_before = #out
    write(out, path, key, reject, ancestors, depth)
    write(out, path_of(path, key), t[key], reject, ancestors, depth + 1)
    if #out == length_before + 1 then out[#out] = nil end
  end
  out[#out + 1] = "}"
  ancestors[t] = nil
end
function write(out, path, value, reject, ancestors, depth)
  local kind = type(value)
  if kind == "number" then
    out[#out + 1] = "n" .. bytes(value)
  elseif kind == "string" then
    out[#out + 1] = "s" .. #value .. ";" .. value
  elseif kind == "boolean" then
    out[#out + 1] = value and "t" or "f"
  elseif kind == "table" then
    write_table(out, path, value, reject, ancestors, depth)
  elseif istype(V, value) then
    out[#out + 1] = "v" .. bytes(value.x, value.y, value.z)
  elseif istype(Q, value) then
    out[#out + 1] = "q" .. bytes(value.x, value.y, value.z, value.w)
  elseif istype(F, value) then
    out[#out + 1] = "b" .. bytes(value.x and 1 or 0, value.y and 1 or 0, value.z and 1 or 0)
  elseif istype(T, value) then
    local number, run = P.timer_text(value)
    out[#out + 1] = "T" .. bytes(number, run, 0)
  else
    reject(path, "is " .. describe(value))
  end
end

-- Not compiled: traces of these two mutually recursive functions sometimes lost count of `depth` (LuaJIT 2.1.0-beta3)
-- and accepted tables that are nested too deeply.
jit.off(write_table)
jit.off(write)

-- a value as text; `name`: its name for reject(). Empty if it is nil or was rejected
function P.plain_text(value, name, reject)
  local out = {}
  if value ~= nil then write(out, name, value, reject, {}, 1) end
  return table.concat(out)
end

-- parsing: returns the value at a position, and the position after it
local parse
local function doubles(text, at, count)
  ffi.copy(buffer, sub(text, at, at + 8 * count - 1), 8 * count)
  return at + 8 * count
end
local function parse_table(text, at)
  local t, key, value = {}, nil, nil
  while byte(text, at) ~= 125 do
    key, at = parse(text, at)
    value, at = parse(text, at)
    t[key] = value
  end
  return t, at + 1
end
function parse(text, at)
  local kind = sub(text, at, at)
  at = at + 1
  if kind == "{" then return parse_table(text, at) end
  if kind == "t" or kind == "f" then return kind == "t", at end
  if kind == "s" then
    local stop = find(text, ";", at, true)
    local last = stop + tonumber(sub(text, at, stop - 1))
    return sub(text, stop + 1, last), last + 1
  end
  at = doubles(text, at, kind == "n" and 1 or kind == "q" and 4 or 3)
  local x, y, z = buffer[0], buffer[1], buffer[2]
  if kind == "n" then return x, at end
  if kind == "v" then return V(x, y, z), at end
  if kind == "T" then return P.timer(x, y), at end
  if kind == "q" then return Q(x, y, z, buffer[3]), at end
  return F(x ~= 0, y ~= 0, z ~= 0), at
end

-- parses a result of plain_text
function P.plain_value(text)
  if text == "" then return nil end
  return (parse(text, 1))
end
