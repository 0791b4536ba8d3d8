-- Types of behaviors written in Lua: a file of behaviors_lua/ is loaded in an environment of its own when a scene first
-- names it, and its declaration becomes a type like the built-in ones.
local P = ...
local ffi, api, ctx, answer = P.ffi, P.api, P.ctx, P.answer
local fail, describe, format, find = P.fail, P.describe, string.format, string.find

local types = {}  -- by file number
P.behavior_types = types

local keys = { doc = true, params = true, group = true, start = true, step = true, migrate = true }
local functions = { "start", "step", "migrate" }
-- members of `self` and of a behavior's handle besides the parameters
local members = { "active", "place", "name", "type", "body", "group", "parts", "joints", "motors", "time", "state",
  "rng", "due", "neighbor_parts", "neighbors", "neighbor_means", "neighbor_push", "error", "remove", "alive",
  "members", "bodies" }

-- the line of the first occurrence of a word; the last line if there is none
local function line_of(text, word)
  local line = 0
  local pattern = word and "%f[%w_]" .. word:gsub("%W", "%%%0") .. "%f[^%w_]"
  for each in (text .. "\n"):gmatch("(.-)\n") do
    line = line + 1
    if pattern and find(each, pattern) and not find(each, "^%s*%-%-") then return line end
  end
  return pattern and line_of(text) or math.max(line - 1, 1)
end

-- an error in a file's declaration, at the line of the word
local function fail_at(type, word, text, ...)
  if select("#", ...) > 0 then text = format(text, ...) end
  error(format("%s:%d: %s", type.display_path, line_of(type.text, word), text), 0)
end

local function check_keys(type, declared)
  for _, key in ipairs(P.sorted_keys(declared)) do
    if not keys[key] then
      fail_at(type, key, "a behavior has no '%s'%s", key, P.hint(key, P.sorted_keys(keys)))
    end
  end
  for _, key in ipairs(functions) do
    local f = declared[key]
    if f ~= nil and _G.type(f) ~= "function" then fail_at(type, key, "%s is a function, not %s", key, describe(f)) end
  end
  if declared.doc ~= nil and _G.type(declared.doc) ~= "string" then
    fail_at(type, "doc", "doc is text, not %s", describe(declared.doc))
  end
  if declared.group ~= nil and _G.type(declared.group) ~= "boolean" then
    fail_at(type, "group", "group is true or false, not %s", describe(declared.group))
  end
  if not declared.step then
    fail_at(type, "behavior", "a behavior has a step: step = function(self, dt) … end")
  end
end

local function plain(name) return (name:lower():gsub("_", "")) end
local reserved = {}
for _, name in ipairs(members) do reserved[plain(name)] = name end

local function check_names(type, params)
  for _, spec in ipairs(params) do
    local name = _G.type(spec) == "table" and spec[1]
    local member = _G.type(name) == "string" and reserved[plain(name)]
    if member then
      fail_at(type, name, "a parameter can't be called '%s': '%s' is a member of every behavior", name, member)
    end
  end
end

-- messages about params have the parameter's name in quotes
local function collect(type, params)
  local ok, fault = pcall(P.collect_params, params)
  if ok then return end
  fault = tostring(fault):gsub("^[^\n]-:%d+: ", "")
  fail_at(type, fault:match("^params: '([%a_][%w_]*)'") or "params", "%s", fault)
end

local function declare(type, declared)
  if declared == nil then
    fail_at(type, nil, "a file of behaviors_lua/ ends with: return behavior { doc = …, params = { … }, " ..
      "step = function(self, dt) … end }")
  end
  if _G.type(declared) ~= "table" then
    fail_at(type, "behavior", "behavior takes a table { … }, not %s", describe(declared))
  end
  for key in pairs(declared) do
    if _G.type(key) ~= "string" then
      fail_at(type, "behavior", "behavior takes named entries, such as step = function(self, dt) … end, not %s",
        describe(declared[key]))
    end
  end
  check_keys(type, declared)
  local params = declared.params == nil and {} or declared.params
  if _G.type(params) == "table" then check_names(type, params) end
  collect(type, params)
  local doc = declared.doc or ""
  if api.behavior_declare(ctx, type.file, doc, #doc, declared.group and 1 or 0) ~= 0 then
    fail_at(type, "behavior", "%s", P.text())
  end
  type.table, type.is_group = answer.count, declared.group == true
  type.start, type.step, type.migrate = declared.start, declared.step, declared.migrate
end

-- the file must return the table that it passed to behavior { … }
local function run(type)
  local env = P.make_env(type.file)
  local definition, returned = nil, nil
  function env.behavior(declared)
    definition = declared
    return declared
  end
  local chunk, fault = P.load(type.text, "@" .. type.display_path, env)
  if not chunk then error(fault, 0) end
  returned = chunk()
  env.behavior = nil
  if returned ~= definition then definition = nil end
  declare(type, definition)
end

local function load_type(name)
  local file = api.behavior_read(ctx, name, #name)
  if file < 0 then fail("%s", P.text()) end
  local type = { file = file }
  type.name, type.display_path, type.text = P.text():match("^(.-)\n(.-)\n(.*)$")
  P.sources[type.display_path] = type.text
  local was_in_behavior = answer.in_behavior
  api.in_behavior(ctx, 1)
  local ok, fault = pcall(run, type)
  api.in_behavior(ctx, was_in_behavior)
  if not ok then
    api.behavior_forget(ctx, file)
    error(fault, 0)
  end
  types[file] = type
  P.make_self(type)
end

-- loads a type on demand; called before a behavior of it is created
function P.require_behavior_type(name)
  local known = api.behavior_known(ctx, name, #name)
  if known < 0 then fail("%s", P.text()) end
  if known == 1 then return end
  if answer.top_level == 0 then
    fail("the behavior type '%s' was not loaded when the scene ran; callbacks can't read files, so use it once " ..
      "at the top level", name)
  end
  load_type(name)
end
