-- A scene's `state`, handed from a run to the one that takes its place.
local P = ...
local api, ctx, format = P.api, P.ctx, string.format

-- what is no plain data is left out, and said once for each place
local said = {}
local function leave_out(path, what)
  if said[path] then return end
  said[path] = true
  local text = format("%s: %s %s and does not outlive a reload; %s", P.main or "scene", path, what, P.plain_kinds)
  api.warn(ctx, text, #text)
end

local function text_of(value, path) return P.plain_text(value, path, leave_out) end
local function table_of(text) return P.plain_value(text) or {} end

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

function P.entry.state() return text_of(state_now(), "state") end
function P.entry.give_state(text) given = text end

-- which keys the top level wrote: the others are the show's
function P.find_written()
  local before, now = table_of(given), state_now() or {}
  written = {}
  local function compare(key)
    local path = "state." .. tostring(key)
    if text_of(rawget(now, key), path) ~= text_of(before[key], path) then written[key] = true end
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

local function same(a, b)
  if type(a) ~= type(b) then return false end
  if type(a) == "cdata" then return text_of(a, "state") == text_of(b, "state") end
  return a == b or a ~= a and b ~= b
end

-- brings the difference between two states into a table that is like the first; what is no plain data stays
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

-- Runs of one scene share `state`: the changes between two texts of it that another run has made.
function P.entry.change_state(before, after)
  local now = state_now()
  if now then change(now, table_of(before), table_of(after)) end
end
