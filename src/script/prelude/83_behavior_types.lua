-- Behaviours written in Lua, their types: a file of behaviors_lua/ is loaded when a scene first names it, in an environment
-- of its own; what it declares becomes a type like the built-in ones.
local P = ...
local ffi, api, ctx, answer = P.ffi, P.api, P.ctx, P.answer
local fail, describe, format, find = P.fail, P.describe, string.format, string.find

local types = {}  -- by the number of the file
P.behavior_types = types

local keys = { doc = true, params = true, group = true, start = true, step = true, migrate = true }
local functions = { "start", "step", "migrate" }
-- what `self` and a behaviour's handle have beside their parameters
local members = { "active", "place", "name", "type", "body", "group", "parts", "joints", "motors", "time", "state", "rng", "due",
  "neighbor_parts", "neighbors", "neighbor_means", "neighbor_push", "error", "remove", "alive", "members", "bodies" }

-- the line in which a word first stands, as a whole; the last line without one
local function line_of(text, word)
  local line = 0
  local pattern = word and "%f[%w_]" .. word:gsub("%W", "%%%0") .. "%f[^%w_]"
  for each in (text .. "\n"):gmatch("(.-)\n") do
    line = line + 1
    if pattern and find(each, pattern) and not find(each, "^%s*%-%-") then return line end
  end
  return pattern and line_of(text) or math.max(line - 1, 1)
end

-- an error about what a file declares, which stands where the word does
local function complain(type, word, text, ...)
  if select("#", ...) > 0 then text = format(text, ...) end
  error(format("%s:%d: %s", type.shown, line_of(type.text, word), text), 0)
end

local function check_keys(type, declared)
  for _, key in ipairs(P.sorted_keys(declared)) do
    if not keys[key] then
      complain(type, key, "a behavior has no '%s'%s", key, P.hint(key, P.sorted_keys(keys)))
    end
  end
  for _, key in ipairs(functions) do
    local f = declared[key]
    if f ~= nil and _G.type(f) ~= "function" then complain(type, key, "%s is a function, not %s", key, describe(f)) end
  end
  if declared.doc ~= nil and _G.type(declared.doc) ~= "string" then
    complain(type, "doc", "doc is text, not %s", describe(declared.doc))
  end
  if declared.group ~= nil and _G.type(declared.group) ~= "boolean" then
    complain(type, "group", "group is true or false, not %s", describe(declared.group))
  end
  if not declared.step then
    complain(type, "behavior", "a behavior has a step: step = function(self, dt) … end")
  end
end

local function plain(name) return (name:lower():gsub("_", "")) end
local taken = {}
for _, name in ipairs(members) do taken[plain(name)] = name end

local function check_names(type, params)
  for _, spec in ipairs(params) do
    local name = _G.type(spec) == "table" and spec[1]
    local member = _G.type(name) == "string" and taken[plain(name)]
    if member then
      complain(type, name, "a parameter can't be called '%s': '%s' is a member of every behavior", name, member)
    end
  end
end

-- the parameter that a message about params is about stands in quotes
local function gather(type, params)
  local ok, fault = pcall(P.gather_rows, params)
  if ok then return end
  fault = tostring(fault):gsub("^[^\n]-:%d+: ", "")
  complain(type, fault:match("^params: '([%a_][%w_]*)'") or "params", "%s", fault)
end

local function declare(type, declared)
  if declared == nil then
    complain(type, nil, "a file of behaviors_lua/ ends with: return behavior { doc = …, params = { … }, step = function(self, dt) … end }")
  end
  if _G.type(declared) ~= "table" then
    complain(type, "behavior", "behavior takes a table { … }, not %s", describe(declared))
  end
  for key in pairs(declared) do
    if _G.type(key) ~= "string" then
      complain(type, "behavior", "behavior takes named entries, such as step = function(self, dt) … end, not %s",
        describe(declared[key]))
    end
  end
  check_keys(type, declared)
  local params = declared.params == nil and {} or declared.params
  if _G.type(params) == "table" then check_names(type, params) end
  gather(type, params)
  local doc = declared.doc or ""
  if api.behavior_declare(ctx, type.file, doc, #doc, declared.group and 1 or 0) ~= 0 then
    complain(type, "behavior", "%s", P.text())
  end
  type.table, type.is_group = answer.count, declared.group == true
  type.start, type.step, type.migrate = declared.start, declared.step, declared.migrate
end

-- what the file returns must be what it gave to behavior { … }
local function run(type)
  local env = P.make_env(type.file)
  local given, returned = nil, nil
  function env.behavior(declared)
    given = declared
    return declared
  end
  local chunk, fault = P.load(type.text, "@" .. type.shown, env)
  if not chunk then error(fault, 0) end
  returned = chunk()
  env.behavior = nil
  if given == nil or returned ~= given then given = nil end
  declare(type, given)
end

local function load_type(name)
  local file = api.behavior_read(ctx, name, #name)
  if file < 0 then fail("%s", P.text()) end
  local type = { file = file }
  type.name, type.shown, type.text = P.text():match("^(.-)\n(.-)\n(.*)$")
  P.sources[type.shown] = type.text
  local outer = answer.in_behavior
  api.in_behavior(ctx, 1)
  local ok, fault = pcall(run, type)
  api.in_behavior(ctx, outer)
  if not ok then
    api.behavior_forget(ctx, file)
    error(fault, 0)
  end
  types[file] = type
  P.make_self(type)
end

-- called with the name of a type before a behaviour of it is made
function P.need_behavior_type(name)
  local known = api.behavior_known(ctx, name, #name)
  if known < 0 then fail("%s", P.text()) end
  if known == 1 then return end
  if answer.top_level == 0 then
    fail("the behavior type '%s' was not loaded when the scene ran; a callback must not wait for a disk, so name it once " ..
      "at the top level", name)
  end
  load_type(name)
end
