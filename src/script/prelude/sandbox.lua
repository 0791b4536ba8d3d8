-- The environment of a script: the only names that it sees. Library tables are copies.
local P = ...
local api, ctx = P.api, P.ctx
local fail, describe = P.fail, P.describe
local native = { pcall = pcall, tonumber = tonumber }

local function joined(...)
  local list = { ... }
  for i = 1, select("#", ...) do list[i] = P.show(list[i]) end
  return table.concat(list, "\t")
end

local function copy(lib, names)
  local t = {}
  for name in names:gmatch("%S+") do t[name] = lib[name] end
  return t
end
local kPlain = "assert error select type unpack rawequal rawget getmetatable pcall"
local kMath = "abs acos asin atan atan2 ceil cos cosh deg exp floor fmod frexp huge ldexp log log10 max min modf " ..
  "pi pow rad sin sinh sqrt tan tanh"
local kBit = "arshift band bnot bor bswap bxor lshift rol ror rshift tobit tohex"

local function add_libraries(env, file)
  env.string, env.table, env.coroutine = P.make_string(), P.make_table(), P.make_coroutine()
  env.math = copy(math, kMath)
  for name, f in pairs(P.math_extra) do env.math[name] = f end
  env.math.random = P.make_random(-2 - file)
  env.bit = copy(bit, kBit)
end

local function add_functions(env)
  for name in kPlain:gmatch("%S+") do env[name] = _G[name] end
  env.ipairs, env.pairs, env.tostring, env.setmetatable = P.ipairs, P.pairs, P.show, P.setmetatable
  -- protects shared objects, which rawset would change in spite of their metatables
  function env.rawset(t, key, value)
    if t == P.osc or t == P.params or t == P.presets then fail("rawset: %s can't be changed", P.show(t)) end
    return P.rawset(t, key, value)
  end
  -- C code would scan a long text without interruption
  function env.tonumber(value, base)
    if type(value) == "string" and #value > 1000 then return nil end
    return native.tonumber(value, base)
  end
  function env.xpcall(f, handler, ...)
    local function finish(ok, ...)
      if ok then return true, ... end
      return false, handler((...))
    end
    return finish(native.pcall(f, ...))
  end
  function env.load(text, name, _, of)
    if type(text) ~= "string" then fail("load takes text, not %s", describe(text)) end
    if #text > 2 ^ 20 then return nil, "load takes up to 1 MB of text" end
    if of ~= nil and type(of) ~= "table" then fail("load's environment is a table, not %s", describe(of)) end
    name = type(name) == "string" and name:gsub("^[@=]", "") or "load"
    return P.load(text, "@" .. name, of or env)
  end
  function env.loadstring(text, name) return env.load(text, name) end
  function env.collectgarbage(option)
    if option ~= "count" then
      fail("collectgarbage accepts only 'count'; Limber collects garbage after each tick")
    end
    return collectgarbage("count")
  end
  function env.print(...)
    local text = joined(...)
    api.print(ctx, text, #text)
  end
  function env.warn(...)
    local text = joined(...)
    api.warn(ctx, text, #text)
  end
end

-- modules of a lib folder run once, in the environment of the script that requires them
local loading = {}
P.on_failure[#P.on_failure + 1] = function() loading = {} end
local function make_require(env, file)
  local loaded = {}
  return function(name)
    if type(name) ~= "string" or not ("." .. name):gsub("%.[%w_]+", ""):find("^$") then
      fail("require takes a name such as 'dance' or 'dance.steps', not %s", describe(name))
    end
    if loaded[name] ~= nil then return loaded[name] end
    for _, other in ipairs(loading) do
      if other == name then fail("circular require: %s -> %s", table.concat(loading, " -> "), name) end
    end
    if api.read_lib(ctx, file, name, #name) ~= 0 then fail("%s", P.text()) end
    local display_path, text = P.text():match("^(.-)\n(.*)$")
    P.sources[display_path] = text
    local chunk, fault = P.load(text, "@" .. display_path, env)
    if not chunk then error(fault, 0) end
    loading[#loading + 1] = name
    local ok, result = native.pcall(chunk, name)
    loading[#loading] = nil
    if not ok then error(result, 0) end
    loaded[name] = result == nil and true or result
    return loaded[name]
  end
end

-- names that exist only in scenes or only in behaviors
local elsewhere = {
  scene = { behavior = "; a behavior is a file of its own in behaviors_lua/" },
  behavior = {
    state = "; a behavior stores its state in self.state",
    result = "; results belong to the scene's file",
  },
}

-- environment of the scene (file -1) or of a behavior file, by its number
function P.make_env(file)
  local env, kind = {}, file < 0 and "scene" or "behavior"
  add_libraries(env, file)
  add_functions(env)
  env.require = make_require(env, file)
  env.vec3, env.quat, env.rgb, env.rng = P.vec3, P.make_quat(), P.rgb, P.R(-2 - file, 0)
  env.sim, env.osc, env.params, env.visuals = P.sim, P.osc, P.params, P.visuals
  env.presets = P.presets
  if kind == "scene" then env.state, env.result = P.first_state(), P.result end
  return setmetatable(env, {
    __index = function(_, key)
      local hint = elsewhere[kind][key] or P.hint(key, P.sorted_keys(env))
      local helps = elsewhere[kind][key] or hint:find("did you mean", 1, true)
      fail("there is no global '%s'%s", tostring(key), helps and hint or "")
    end,
    __metatable = "environment",
  })
end

local function run_chunk(text, name)
  P.sources[name] = text
  local chunk, message = P.load(text, "@" .. name, P.env)
  if not chunk then error(message, 0) end
  chunk()
end

local function compile_and_run(text, name, added)
  P.env = P.make_env(-1)
  run_chunk(text, name)
  if added ~= "" then run_chunk(added, "added models") end
end

-- runs a scene's file, then the text of the models that were added to it; false if it fails
function P.exports.run(text, name, added)
  P.main = name
  return P.guarded_run(compile_and_run, text, name, added)
end

-- all names that a scene sees, one per line: globals, members of libraries, then members and methods of objects
function P.exports.names()
  local lines = {}
  local env = P.make_env(-1)
  for _, name in ipairs(P.sorted_keys(env)) do
    local value = rawget(env, name)
    lines[#lines + 1] = name
    if type(value) == "table" and (getmetatable(value) == nil or name == "quat") then
      for _, key in ipairs(P.sorted_keys(value)) do lines[#lines + 1] = name .. "." .. key end
    end
  end
  for _, key in ipairs(P.osc_members) do lines[#lines + 1] = "osc." .. key end
  for _, key in ipairs(P.preset_members) do lines[#lines + 1] = "presets." .. key end
  for _, name in ipairs(P.class_names) do
    local class = P.classes[name]
    for _, key in ipairs(P.sorted_keys(class.getters)) do lines[#lines + 1] = name .. "." .. key end
    for _, key in ipairs(P.sorted_keys(class.methods)) do lines[#lines + 1] = name .. ":" .. key end
  end
  return table.concat(lines, "\n") .. "\n"
end
