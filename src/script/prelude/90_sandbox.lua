-- The environment of a script: the names that it sees, and nothing else. Library tables are copies.
local P = ...
local ffi, api, ctx, istype = P.ffi, P.api, P.ctx, P.ffi.istype
local fail, describe = P.fail, P.describe
local native = { tostring = tostring, pcall = pcall, format = string.format, gsub = string.gsub,
  sort = table.sort, resume = coroutine.resume, create = coroutine.create, getmetatable = debug.getmetatable }

-- tables, functions and coroutines have no address in texts: it would differ from run to run
local function show(value)
  local kind = type(value)
  if kind == "table" then
    local meta = native.getmetatable(value)
    return type(meta) == "table" and rawget(meta, "__tostring") and native.tostring(value) or "table"
  end
  if kind == "function" or kind == "thread" or kind == "userdata" then return kind end
  return native.tostring(value)
end

local function plain(...)
  for i = 1, select("#", ...) do
    local kind = type((select(i, ...)))
    if kind ~= "number" and kind ~= "string" and kind ~= "boolean" and kind ~= "nil" then return false end
  end
  return true
end
local function string_format(text, ...)
  if type(text) == "string" and text:find("%%[^%%%a]*p") then
    fail("string.format: %p tells an address, which differs in each run")
  end
  if plain(...) then return native.format(text, ...) end
  local values, n = { ... }, select("#", ...)
  for i = 1, n do
    if not plain(values[i]) then values[i] = show(values[i]) end
  end
  return native.format(text, unpack(values, 1, n))
end

-- a replacing function that calls gsub again and again would eat the C stack
local gsub_depth = 0
local function string_gsub(text, pattern, replacement, most)
  if type(replacement) ~= "function" then return native.gsub(text, pattern, replacement, most) end
  if gsub_depth >= 16 then fail("string.gsub inside string.gsub, 16 deep: that is too deep") end
  gsub_depth = gsub_depth + 1
  local ok, result, count = native.pcall(native.gsub, text, pattern, replacement, most)
  gsub_depth = gsub_depth - 1
  if not ok then error(result, 0) end
  return result, count
end

-- so would coroutines inside coroutines
local coroutine_depth = 0
local function leave(...)
  coroutine_depth = coroutine_depth - 1
  return ...
end
local function resume(co, ...)
  if type(co) ~= "thread" then fail("coroutine.resume takes a coroutine, not %s", describe(co)) end
  if coroutine_depth >= 100 then fail("coroutines inside coroutines, 100 deep: that is too deep") end
  coroutine_depth = coroutine_depth + 1
  return leave(native.resume(co, ...))
end
local function unwrap(ok, ...)
  if not ok then error(..., 0) end
  return ...
end
local function wrap(f)
  local co = native.create(f)
  return function(...) return unwrap(resume(co, ...)) end
end

local function ascending(a, b) return a < b end
local function sort(t, before) return native.sort(t, before or ascending) end

-- pairs in a fixed order: numbers, text by alphabet, false and true, things in stream order
local function thing_order(key) return api.order(ctx, key.slot_, key.generation_) end
local function by_order(a, b) return thing_order(a) < thing_order(b) end
local function gather_keys(t)
  local numbers, texts, flags, things, sorted, last = {}, {}, {}, {}, true, -math.huge
  for key in next, t do
    local kind = type(key)
    if kind == "number" then
      numbers[#numbers + 1], sorted, last = key, sorted and key > last, key
    elseif kind == "string" then
      texts[#texts + 1] = key
    elseif kind == "boolean" then
      flags[key and 2 or 1] = key
    elseif P.class_of(key) then
      things[#things + 1] = key
    else
      fail("pairs: a key of this table is a %s, which has no place in a fixed order; use numbers, text or things", kind)
    end
  end
  if not sorted then native.sort(numbers, ascending) end
  native.sort(texts, ascending)
  native.sort(things, by_order)
  for _, key in ipairs(texts) do numbers[#numbers + 1] = key end
  for i = 1, 2 do
    if flags[i] ~= nil then numbers[#numbers + 1] = flags[i] end
  end
  for _, key in ipairs(things) do numbers[#numbers + 1] = key end
  return numbers
end
local function next_left(keys, t, i)
  while keys[i] ~= nil and rawget(t, keys[i]) == nil do i = i + 1 end
  return i
end
local function next_pair(walk)
  local keys, t, i = walk.keys, walk.t, walk.i + 1
  local key = keys[i]
  if key ~= nil and rawget(t, key) == nil then
    i = next_left(keys, t, i)
    key = keys[i]
  end
  walk.i = i
  if key == nil then return nil end
  return key, rawget(t, key)
end
local function fixed_pairs(t)
  if istype(P.L, t) or istype(P.S, t) or istype(P.F, t) then return P.ipairs(t) end
  if type(t) ~= "table" then fail("pairs takes a table, not %s", describe(t)) end
  return next_pair, { t = t, keys = gather_keys(t), i = 0 }
end

P.pairs = fixed_pairs

local function joined(...)
  local list = { ... }
  for i = 1, select("#", ...) do list[i] = show(list[i]) end
  return table.concat(list, "\t")
end

local function copy(lib, names)
  local t = {}
  for name in names:gmatch("%S+") do t[name] = lib[name] end
  return t
end
local kPlain = "assert error select tonumber type unpack rawequal rawget rawset getmetatable setmetatable pcall"
local kString = "byte char find gmatch len lower match rep reverse sub upper"
local kMath = "abs acos asin atan atan2 ceil cos cosh deg exp floor fmod frexp huge ldexp log log10 max min modf " ..
  "pi pow rad sin sinh sqrt tan tanh"
local kBit = "arshift band bnot bor bswap bxor lshift rol ror rshift tobit tohex"

local function make_string()
  local t = copy(string, kString)
  t.format, t.gsub = string_format, string_gsub
  return t
end

-- ("x"):upper() finds a table of its own
local meta = native.getmetatable("")
meta.__index, meta.__metatable = make_string(), "string"

local function add_libraries(env, file)
  env.string = make_string()
  env.table = copy(table, "concat insert remove maxn")
  env.table.sort = sort
  env.math = copy(math, kMath)
  for name, f in pairs(P.math_extra) do env.math[name] = f end
  env.math.random = P.make_random(-2 - file)
  env.bit = copy(bit, kBit)
  env.coroutine = copy(coroutine, "create yield status running")
  env.coroutine.resume, env.coroutine.wrap = resume, wrap
end

local function add_functions(env)
  for name in kPlain:gmatch("%S+") do env[name] = _G[name] end
  env.ipairs, env.pairs, env.tostring = P.ipairs, fixed_pairs, show
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
    name = type(name) == "string" and name:gsub("^[@=]", "") or "load"
    return P.load(text, "@" .. name, of or env)
  end
  function env.loadstring(text, name) return env.load(text, name) end
  function env.collectgarbage(what)
    if what ~= "count" then
      fail("collectgarbage: scripts may ask for 'count' only; limber collects after each tick")
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

-- modules of a lib folder run in the environment of the script that requires them, once
local function make_require(env, file)
  local loaded, loading = {}, {}
  return function(name)
    if type(name) ~= "string" or not ("." .. name):gsub("%.[%w_]+", ""):find("^$") then
      fail("require takes a name such as 'dance' or 'dance.steps', not %s", describe(name))
    end
    if loaded[name] ~= nil then return loaded[name] end
    for _, other in ipairs(loading) do
      if other == name then fail("require goes in a circle: %s -> %s", table.concat(loading, " -> "), name) end
    end
    if api.read_lib(ctx, file, name, #name) ~= 0 then fail("%s", P.text()) end
    local shown, text = P.text():match("^(.-)\n(.*)$")
    P.sources[shown] = text
    local chunk, fault = P.load(text, "@" .. shown, env)
    if not chunk then error(fault, 0) end
    loading[#loading + 1] = name
    local ok, result = native.pcall(chunk, name)
    loading[#loading] = nil
    if not ok then error(result, 0) end
    loaded[name] = result == nil and true or result
    return loaded[name]
  end
end

-- names that one kind of script has and the other has not
local elsewhere = {
  scene = { behavior = "; a behavior is a file of its own in behaviors_lua/" },
  behavior = { state = "; a behavior keeps what it remembers in self.state" },
}

-- of the scene (file -1), or of a behaviour's file, by its number
function P.make_env(file)
  local env, kind = {}, file < 0 and "scene" or "behavior"
  add_libraries(env, file)
  add_functions(env)
  env.require = make_require(env, file)
  env.vec3, env.quat, env.rgb, env.rng = P.vec3, P.make_quat(), P.rgb, P.R(-2 - file, 0)
  env.sim, env.osc, env.params = P.sim, P.osc, P.params
  if kind == "scene" then env.state = {} end
  return setmetatable(env, {
    __index = function(_, key)
      local hint = elsewhere[kind][key] or P.hint(key, P.sorted_keys(env))
      local helps = elsewhere[kind][key] or hint:find("did you mean", 1, true)
      fail("there is no global '%s'%s", tostring(key), helps and hint or "")
    end,
    __metatable = "environment",
  })
end

local function compile_and_run(text, name)
  local chunk, message = P.load(text, "@" .. name, P.make_env(-1))
  if not chunk then error(message, 0) end
  chunk()
end

-- runs a scene's file; false when it fails
function P.entry.run(text, name)
  P.sources[name], P.main = text, name
  return P.guarded_run(compile_and_run, text, name)
end

-- every name that a scene sees, one a line: globals, members of libraries, then members and methods of things
function P.entry.names()
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
  for _, name in ipairs { "sim", "body", "part", "joint", "motor", "shape" } do
    local class = P.classes[name]
    for _, key in ipairs(P.sorted_keys(class.getters)) do lines[#lines + 1] = name .. "." .. key end
    for _, key in ipairs(P.sorted_keys(class.methods)) do lines[#lines + 1] = name .. ":" .. key end
  end
  return table.concat(lines, "\n") .. "\n"
end
