-- A scene's `state`, passed from a run to its successor.
local P = ...
local api, ctx, format = P.api, P.ctx, string.format

-- values that are not plain data are omitted, reported once for each path
local reported = {}
local function omit(path, reason)
  if reported[path] then return end
  reported[path] = true
  local text = format("%s: %s %s and does not survive a reload; %s", P.main or "scene", path, reason, P.plain_kinds)
  api.warn(ctx, text, #text)
end

local function text_of(value, path) return P.plain_text(value, path, omit) end
local function table_of(text) return P.plain_value(text) or {} end

-- tables keep their identity, because a script may have references to them
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

local initial_text, written_keys = "", {}

-- initial value of `state` for the top level
function P.first_state() return table_of(initial_text) end

function P.exports.state() return text_of(state_now(), "state") end
function P.exports.set_initial_state(text) initial_text = text end

-- finds the keys that the top level wrote; the others are taken over from the live run
function P.find_written()
  local before, now = table_of(initial_text), state_now() or {}
  written_keys = {}
  local function compare(key)
    local path = "state." .. tostring(key)
    if text_of(rawget(now, key), path) ~= text_of(before[key], path) then written_keys[key] = true end
  end
  for key in next, now do compare(key) end
  for key in next, before do compare(key) end
end

function P.exports.adopt_state(text)
  local now = state_now()
  if text == initial_text or not now then return end
  local merged = table_of(text)
  for key in next, written_keys do merged[key] = rawget(now, key) end
  fill(now, merged)
end

local function same(a, b)
  if type(a) ~= type(b) then return false end
  if type(a) == "cdata" then return text_of(a, "state") == text_of(b, "state") end
  return a == b or a ~= a and b ~= b
end

-- applies the difference between two states to a table that equals the first; values that are not plain data stay
local function change(target, before, after)
  for key in next, before do
    if after[key] == nil then target[key] = nil end
  end
  for key, value in next, after do
    local was, now = before[key], rawget(target, key)
    if type(value) == "table" and type(was) == "table" and type(now) == "table" then
      change(now, was, value)
    elseif not same(was, value) then
      rawset(target, key, value)
    end
  end
end

-- Runs of one scene share `state`: applies the changes made by another run.
function P.exports.change_state(before, after)
  local now = state_now()
  if now then change(now, table_of(before), table_of(after)) end
end
