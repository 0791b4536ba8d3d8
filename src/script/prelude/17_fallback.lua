-- Reports loops and functions of scripts that LuaJIT has given up compiling: it marks them in their code, which is read here,
-- a little after each tick. They are interpreted from then on, until the file is saved.
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
local kPerTick = 4      -- functions that are looked at after a tick
local kMostWatched = 5000

-- first and last instruction of the loop that the one at `at` belongs to, or nil
local function range_of(op, at, ins)
  local target = at + 1 + rshift(ins, 16) - 0x8000
  if op == kForEnd or op == kEachEnd then return target, at end
  if op == kLoop then return at, target end
end

-- places of loops without a loop inside, and of the beginning when there is no loop at all; whether it makes functions
local function places_of(proto)
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
  local places = {}
  for _, outer in ipairs(loops) do
    local innermost = true
    for _, inner in ipairs(loops) do
      if inner ~= outer and inner.first >= outer.first and inner.last <= outer.last then innermost = false end
    end
    if innermost then places[#places + 1] = { at = outer.at, given_up = outer.op + 1, what = "loop" } end
  end
  local head = band(funcbc(proto, 0), 0xff)
  if #loops == 0 and head ~= kFunction then places[1] = { at = 0, given_up = head + 1, what = "function" } end
  return places, closure
end

local watched = setmetatable({}, { __mode = "k" })  -- functions: their places
local list = setmetatable({}, { __mode = "v" })
local count, next_one = 0, 1
local said = {}

function P.watch(proto)
  if count >= kMostWatched then return end
  local places, closure = places_of(proto)
  if #places == 0 then return end
  places.closure = closure
  count = count + 1
  watched[proto], list[count] = places, proto
end

local function report(proto, place, closure)
  local info = funcinfo(proto, place.at)
  local line = place.at == 0 and info.linedefined or info.currentline
  local key = format("%s:%d", sub(info.source, 2), line)
  if said[key] then return end
  said[key] = true
  local text = format("%s: LuaJIT doesn't compile this %s, so that it runs many times slower; %s", key, place.what,
    closure and "make its functions outside of it" or "docs/luajit.md lists what it can't compile")
  api.warn(ctx, text, #text)
end

local function look_at(proto)
  local places = watched[proto]
  if P.is_interpreted(proto) then return false end
  local i = 1
  while places[i] do
    local place = places[i]
    if band(funcbc(proto, place.at), 0xff) == place.given_up then
      report(proto, place, places.closure)
      table.remove(places, i)
    else
      i = i + 1
    end
  end
  return #places > 0
end

function P.report_fallbacks()
  for _ = 1, math.min(kPerTick, count) do
    if next_one > count then next_one = 1 end
    local proto = list[next_one]
    if proto and look_at(proto) then
      next_one = next_one + 1
    else
      list[next_one], list[count] = list[count], nil
      count = count - 1
    end
  end
end
jit.off(P.report_fallbacks, true)
jit.off(look_at)
