-- Reports loops and functions of scripts that LuaJIT has given up compiling and interprets until the next reload.
-- LuaJIT marks them in their bytecode, which is checked here, a little after each tick.
local P = ...
local api, ctx = P.api, P.ctx
local util = require("jit.util")
local funcbc, funcinfo = util.funcbc, util.funcinfo
local band, rshift, format, sub = bit.band, bit.rshift, string.format, string.sub

local function opcode(text, at) return (band(funcbc(loadstring(text), at), 0xff)) end
local kFunction = opcode("return function() end", 0)  -- of a chunk: with `...`, which is never compiled
local kClosure = opcode("return function() end", 1)
local kForEnd = opcode("for i = 1, 2 do end", 5)
local kEachEnd = opcode("for a in f do end", 5)
local kLoop = opcode("while true do end", 1)
local kPerTick = 4      -- functions checked per tick
local kMaxWatched = 5000

-- first and last instruction of the loop that the instruction at `at` belongs to, or nil
local function range_of(op, at, ins)
  local target = at + 1 + rshift(ins, 16) - 0x8000
  if op == kForEnd or op == kEachEnd then return target, at end
  if op == kLoop then return at, target end
end

-- locations of innermost loops, or of the function's start if it has no loop; and whether it creates functions
local function locations_of(proto)
  local loops, closure = {}, false
  local at = 0
  while true do
    local ins = funcbc(proto, at)
    if not ins then break end
    local op = band(ins, 0xff)
    if op == kClosure then closure = true end
    local first, last = range_of(op, at, ins)
    if first then loops[#loops + 1] = { at = at, first = first, last = last, op = op } end
    at = at + 1
  end
  local locations = {}
  for _, outer in ipairs(loops) do
    local innermost = true
    for _, inner in ipairs(loops) do
      if inner ~= outer and inner.first >= outer.first and inner.last <= outer.last then innermost = false end
    end
    if innermost then locations[#locations + 1] = { at = outer.at, given_up = outer.op + 1, kind = "loop" } end
  end
  local head = band(funcbc(proto, 0), 0xff)
  if #loops == 0 and head ~= kFunction then locations[1] = { at = 0, given_up = head + 1, kind = "function" } end
  return locations, closure
end

local watched = setmetatable({}, { __mode = "k" })  -- functions and their locations
local list = setmetatable({}, { __mode = "v" })
local count, next_index = 0, 1
local reported = {}

function P.watch(proto)
  if count >= kMaxWatched then return end
  local locations, closure = locations_of(proto)
  if #locations == 0 then return end
  locations.closure = closure
  count = count + 1
  watched[proto], list[count] = locations, proto
end

local function report(proto, location, closure)
  local info = funcinfo(proto, location.at)
  local line = location.at == 0 and info.linedefined or info.currentline
  local key = format("%s:%d", sub(info.source, 2), line)
  if reported[key] then return end
  reported[key] = true
  local text = format("%s: LuaJIT doesn't compile this %s, so it runs many times slower; %s", key, location.kind,
    closure and "create its functions outside of it" or "see docs/understand/luajit.md for code that it can't compile")
  api.warn(ctx, text, #text)
end

local function check(proto)
  local locations = watched[proto]
  if P.is_interpreted(proto) then return false end
  local i = 1
  while locations[i] do
    local location = locations[i]
    if band(funcbc(proto, location.at), 0xff) == location.given_up then
      report(proto, location, locations.closure)
      table.remove(locations, i)
    else
      i = i + 1
    end
  end
  return #locations > 0
end

function P.report_fallbacks()
  for _ = 1, math.min(kPerTick, count) do
    if next_index > count then next_index = 1 end
    local proto = list[next_index]
    if proto and check(proto) then
      next_index = next_index + 1
    else
      list[next_index], list[count] = list[count], nil
      count = count - 1
    end
  end
end
jit.off(P.report_fallbacks, true)
jit.off(check)
