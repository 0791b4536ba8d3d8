-- Works around faults of LuaJIT's compiler that replaced functions can't prevent. Affected functions of scripts are
-- interpreted, or compiled without the faulty optimization. Each fault has a test in tests/script/luajit_faults/ and an
-- entry in docs/understand/luajit.md.
local P = ...
local util = require("jit.util")
local funcbc, funck = util.funcbc, util.funck
local band, rshift = bit.band, bit.rshift

-- Debian 12 has 2.1.0-beta3: libluajit-5.1 of 2022 and libluajit2-5.1 of 2023. Later releases have numbers.
local kBeta3 = jit.version == "LuaJIT 2.1.0-beta3"

-- Array bounds check elimination is faulty for tables that change; turning it off has no measurable cost.
jit.opt.start("-abc")

-- names of the relevant opcodes, found by compiling sample texts: the instruction at `at`
local names = {}
local function opcode(text, at) return (band(funcbc(loadstring(text), at), 0xff)) end
local function name_opcode(name, text, at) names[opcode(text, at)] = name end
name_opcode("vararg", "local a = ...", 1)
name_opcode("concat", "local a, b local c = a .. b", 4)
name_opcode("nil", "local t = 1 t[1] = nil", 2)
name_opcode("nils", "local a, b", 1)
name_opcode("new", "local t = {}", 1)
name_opcode("constant", "local t = { 1 }", 1)
name_opcode("length", "local t local n = #t", 2)
name_opcode("field", "local t t.x = t", 2)
name_opcode("element", "local t, i t[i] = t", 2)
name_opcode("element", "local t t[1] = t", 2)
name_opcode("call", "local f f()", 3)
name_opcode("call", "local f f(...)", 4)
name_opcode("call", "local f return f()", 3)
name_opcode("call", "local f return f(...)", 4)
name_opcode("loop", "for i = 1, 2 do end", 4)
name_opcode("loop", "while true do end", 1)
name_opcode("loop", "for a in f do end", 4)
name_opcode("loop", "for a in pairs(f) do end", 4)
local kMove = opcode("local f f()", 2)  -- opcodes before it are comparisons; their first operand is not a result

-- True if the table created in register r by the instruction at `at` is only used as an argument of a call.
local function is_argument(proto, at, r)
  while true do
    at = at + 1
    local ins = funcbc(proto, at)
    if not ins then return false end
    local name, a, b = names[band(ins, 0xff)], band(rshift(ins, 8), 0xff), rshift(ins, 24)
    if name == "call" and a < r then return true end
    local fills = (name == "field" or name == "element") and b == r
    if not fills and a <= r then return false end
  end
end

-- Collects the relevant properties of a function.
local function scan(proto)
  local found, fresh, empty, last_empty = {}, {}, -1, -1
  local at = 0
  while true do
    at = at + 1
    local ins = funcbc(proto, at)
    if not ins then return found end
    local op, a, b, c = band(ins, 0xff), band(rshift(ins, 8), 0xff), rshift(ins, 24), band(rshift(ins, 16), 0xff)
    local name = names[op]
    if name == "vararg" then
      -- a fixed number of values: compiled code that starts inside the function does not know the caller
      if b ~= 0 and (found.call or found.loop) then found.misread = true end
    elseif name == "new" or name == "constant" then
      fresh[a] = {}
      if name == "constant" and not is_argument(proto, at, a) then found.constant_stored = true end
    elseif name == "nil" then
      if rshift(ins, 16) == 0 then empty, last_empty = a, a end
    elseif name == "nils" then
      empty, last_empty = a, rshift(ins, 16)
    elseif name == "field" or name == "element" then
      local keys = fresh[b]
      if name == "field" and keys then
        if keys[c] then found.key_twice = true end
        keys[c] = true
      end
      if name == "element" then found.element = true end
      if a >= empty and a <= last_empty then
        found.clears = true
        if keys then found.outgrown = true end
      end
    elseif name == "length" then
      if found.length then found.lengths = true end
      found.length = true
    elseif name then
      found[name] = true
    elseif op >= kMove then
      fresh[a] = nil
    end
  end
end

local function constants(proto, f)
  local at = -1
  local constant = funck(proto, at)
  while constant ~= nil do
    f(constant)
    at = at - 1
    constant = funck(proto, at)
  end
end

local interpreted = setmetatable({}, { __mode = "k" })
local function interpret(proto)
  jit.off(proto)
  interpreted[proto] = true
end
function P.is_interpreted(proto) return interpreted[proto] ~= nil end

-- Metamethods that make compiled code of a group of functions wrong. The group is compiled until a script has such a
-- metamethod.
-- __concat     in functions with `..`: crashes with `...` or pcall as the metamethod, and loses errors
-- __newindex   in functions that set elements to nil, on Debian 12: not called if the table is accessed by another name
local groups = { __concat = {}, __newindex = {} }
for _, group in pairs(groups) do group.waiting = setmetatable({}, { __mode = "k" }) end
local function join_group(name, proto)
  local group = groups[name]
  if group.interpreted then interpret(proto) else group.waiting[proto] = true end
end
local function interpret_group(name)
  local group = groups[name]
  if not group or group.interpreted then return end
  group.interpreted = true
  for proto in pairs(group.waiting) do interpret(proto) end
  group.waiting = nil
end

-- On Debian 12, loop optimization confuses constant tables that a variable holds in turn, and lengths of a table with
-- two names. Scripts that store such tables, or use lengths and set elements, are compiled without it.
local has_length, has_element = false, false
local forbidden = {}
local function forbid(optimization)
  if forbidden[optimization] then return end
  forbidden[optimization] = true
  jit.opt.start("-" .. optimization)
  jit.flush()
end

local function inspect(proto, is_chunk)
  local found = scan(proto)
  if kBeta3 and (found.misread or found.key_twice or found.outgrown) then interpret(proto) end
  if found.concat then join_group("__concat", proto) end
  if kBeta3 and found.clears then join_group("__newindex", proto) end
  local uses_tables = false
  constants(proto, function(constant)
    if type(constant) == "proto" then return inspect(constant) end
    interpret_group(constant)
    -- sums below a bit operation would be computed with 32 bits, which differs beyond 2^51
    if constant == "bit" then forbid("narrow") end
    if constant == "table" then uses_tables = true end
  end)
  if not is_chunk then P.watch(proto) end
  if not kBeta3 then return end
  -- a length may be reused although an element was set through another name in between
  if found.lengths and (found.element or uses_tables) then interpret(proto) end
  if is_chunk then
    -- it runs once, and is interpreted after a reload
    if found.loop and (found.constant_stored or found.length or uses_tables) then interpret(proto) end
    return
  end
  has_length, has_element = has_length or found.length or uses_tables, has_element or found.element or uses_tables
  if found.constant_stored or (has_length and has_element) then forbid("loop") end
end

local load = P.load
function P.load(text, name, env)
  local chunk, fault = load(text, name, env)
  if chunk then inspect(chunk, true) end
  return chunk, fault
end

-- Handles a metatable field with a name that no function mentions. Entries of weak tables would disappear when the
-- collector runs, at a different tick in each run, so tables of scripts are never weak.
local function accept_field(name)
  if name ~= "__mode" then
    interpret_group(name)
    return true
  end
  P.warn_once("__mode is ignored: entries of weak tables would disappear at a different tick in each run. " ..
    "Remove them with = nil")
  return false
end

function P.setmetatable(t, meta)
  if type(meta) == "table" then
    for name in pairs(groups) do
      if rawget(meta, name) ~= nil then interpret_group(name) end
    end
    if rawget(meta, "__mode") ~= nil and not accept_field("__mode") then rawset(meta, "__mode", nil) end
  end
  return setmetatable(t, meta)
end

function P.rawset(t, key, value)
  if type(t) == "table" and type(key) == "string" and value ~= nil and not accept_field(key) then return t end
  return rawset(t, key, value)
end
