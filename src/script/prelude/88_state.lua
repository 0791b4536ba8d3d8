-- `state` as plain data: written as one text, read from it, and handed from a run to the one that takes its place.
local P = ...
local ffi, api, ctx, istype, describe = P.ffi, P.api, P.ctx, P.ffi.istype, P.describe
local V, Q, F = P.V, P.Q, P.F
local format, byte, sub, concat = string.format, string.byte, string.sub, table.concat

local kDeepest = 100
local buffer = ffi.new("double[4]")
local function bytes(x, y, z, w)
  buffer[0], buffer[1], buffer[2], buffer[3] = x, y or 0, z or 0, w or 0
  return ffi.string(buffer, w and 32 or z and 24 or 8)
end

-- what is no plain data is left out, and said once for each place
local said = {}
local function leave_out(path, value, cure)
  if said[path] then return end
  said[path] = true
  local text = format("%s: %s is %s, which does not outlive a reload; %s", P.main or "state", path, describe(value), cure)
  api.warn(ctx, text, #text)
end

local function less(a, b) return a < b end
-- keys in a fixed order, so that equal tables give equal texts
local function keys_of(t, path)
  local numbers, texts, keys = {}, {}, {}
  for key in next, t do
    local kind = type(key)
    if kind == "number" then numbers[#numbers + 1] = key
    elseif kind == "string" then texts[#texts + 1] = key
    elseif kind ~= "boolean" then leave_out(path, key, "as a key it is left out: use numbers or text") end
  end
  table.sort(numbers, less)
  table.sort(texts, less)
  for i = 1, #numbers do keys[i] = numbers[i] end
  for i = 1, #texts do keys[#keys + 1] = texts[i] end
  if rawget(t, false) ~= nil then keys[#keys + 1] = false end
  if rawget(t, true) ~= nil then keys[#keys + 1] = true end
  return keys
end

local write
local function write_table(out, t, path, depth, open)
  if open[t] then return leave_out(path, t, "it holds itself") end
  if depth > kDeepest then return leave_out(path, t, "it lies more than 100 tables deep") end
  open[t] = true
  out[#out + 1] = "{"
  for _, key in ipairs(keys_of(t, path)) do
    local value = rawget(t, key)
    local mark = #out
    write(out, key, path, depth, open)
    local before = #out
    write(out, value, format("%s.%s", path, tostring(key)), depth + 1, open)
    -- a value that was left out takes its key along
    if #out == before then out[mark + 1] = nil end
  end
  out[#out + 1] = "}"
  open[t] = nil
  return true
end
function write(out, value, path, depth, open)
  local kind = type(value)
  if kind == "number" then out[#out + 1] = "n" .. bytes(value)
  elseif kind == "string" then out[#out + 1] = "s" .. #value .. ":" .. value
  elseif kind == "boolean" then out[#out + 1] = value and "t" or "f"
  elseif kind == "table" then write_table(out, value, path, depth, open)
  elseif istype(V, value) then out[#out + 1] = "v" .. bytes(value.x, value.y, value.z)
  elseif istype(Q, value) then out[#out + 1] = "q" .. bytes(value.x, value.y, value.z, value.w)
  elseif istype(F, value) then
    out[#out + 1] = "b" .. bytes(value.x and 1 or 0, value.y and 1 or 0, value.z and 1 or 0)
  else
    leave_out(path, value, P.class_of(value) and "keep its name" or "keep numbers, text, booleans, vec3, quat, tables")
  end
end

-- reading: what stands at a place, and the place behind it
local read
local function doubles(text, at, count)
  ffi.copy(buffer, sub(text, at, at + 8 * count - 1), 8 * count)
  return at + 8 * count
end
local function read_table(text, at)
  local t = {}
  while byte(text, at) ~= 125 do
    local key, value
    key, at = read(text, at)
    value, at = read(text, at)
    t[key] = value
  end
  return t, at + 1
end
function read(text, at)
  local kind = sub(text, at, at)
  at = at + 1
  if kind == "{" then return read_table(text, at) end
  if kind == "t" then return true, at end
  if kind == "f" then return false, at end
  if kind == "s" then
    local colon = text:find(":", at, true)
    local last = colon + tonumber(sub(text, at, colon - 1))
    return sub(text, colon + 1, last), last + 1
  end
  if kind == "n" then
    at = doubles(text, at, 1)
    return buffer[0], at
  end
  at = doubles(text, at, kind == "q" and 4 or 3)
  local x, y, z = buffer[0], buffer[1], buffer[2]
  if kind == "v" then return V(x, y, z), at end
  if kind == "q" then return Q(x, y, z, buffer[3]), at end
  return F(x ~= 0, y ~= 0, z ~= 0), at
end

local function text_of(state)
  local out = {}
  if type(state) == "table" then write_table(out, state, "state", 0, {}) end
  return concat(out)
end
local function table_of(text)
  if text == "" then return {} end
  return (read(text, 1))
end

-- tables keep being the same ones: a script may hold one of them elsewhere
local function fill(target, source)
  for key in next, target do
    if source[key] == nil then target[key] = nil end
  end
  for key, value in next, source do
    local old = rawget(target, key)
    if type(old) == "table" and type(value) == "table" then fill(old, value) else rawset(target, key, value) end
  end
end

local function state_now()
  local state = P.env and rawget(P.env, "state")
  return type(state) == "table" and state or nil
end

local given, written = "", {}

-- what `state` is when the top level begins
function P.first_state() return table_of(given) end

function P.entry.state() return text_of(state_now()) end
function P.entry.give_state(text) given = text end

-- which keys the top level wrote: the others are the show's
function P.find_written()
  local before, now = table_of(given), state_now() or {}
  written = {}
  local function text(value, key)
    local out = {}
    if value ~= nil then write(out, value, "state." .. tostring(key), 1, {}) end
    return concat(out)
  end
  local function compare(key)
    if text(rawget(now, key), key) ~= text(before[key], key) then written[key] = true end
  end
  for key in next, now do compare(key) end
  for key in next, before do compare(key) end
end

function P.entry.take_state(text)
  local now = state_now()
  if text == given or not now then return end
  local live = table_of(text)
  for key in next, written do live[key] = rawget(now, key) end
  fill(now, live)
end
