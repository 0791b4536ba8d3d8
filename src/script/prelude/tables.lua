-- `table`, `coroutine` and pairs for scripts: functions that can take long are written in Lua, where they can be
-- stopped, and the use of the C stack is bounded.
local P = ...
local api, ctx, istype = P.api, P.ctx, P.ffi.istype
local fail, describe, floor = P.fail, P.describe, math.floor
local native = { concat = table.concat, insert = table.insert, maxn = table.maxn, remove = table.remove, pcall = pcall,
  resume = coroutine.resume, create = coroutine.create }

local function check_table(t, subject)
  if type(t) ~= "table" then fail("%s takes a table, not %s", subject, describe(t)) end
  return t
end

-- Merge sort of short runs sorted by insertion. Stable. An inconsistent comparison function gives an unspecified order;
-- if it raises an error the table is unchanged.
local function ascending(a, b) return a < b end
local kRun = 8
local function sort_runs(list, n, before)
  for start = 1, n, kRun do
    for i = start + 1, math.min(start + kRun - 1, n) do
      local value, k = list[i], i - 1
      while k >= start and before(value, list[k]) do
        list[k + 1] = list[k]
        k = k - 1
      end
      list[k + 1] = value
    end
  end
end
local function merge(from, to, left, middle, right, before)
  local i, k = left, middle
  for at = left, right - 1 do
    if i < middle and (k >= right or not before(from[k], from[i])) then
      to[at] = from[i]
      i = i + 1
    else
      to[at] = from[k]
      k = k + 1
    end
  end
end
function P.sort(t, before)
  check_table(t, "table.sort")
  if before ~= nil then P.check_function(before, "table.sort") end
  before = before or ascending
  local n, list, other = #t, {}, {}
  for i = 1, n do list[i] = t[i] end
  sort_runs(list, n, before)
  local width = kRun
  while width < n do
    for left = 1, n, 2 * width do
      merge(list, other, left, math.min(left + width, n + 1), math.min(left + 2 * width, n + 1), before)
    end
    list, other, width = other, list, 2 * width
  end
  for i = 1, n do t[i] = list[i] end
end

local T = { sort = P.sort }
function T.concat(t, separator, first, last)
  check_table(t, "table.concat")
  local ok, text = native.pcall(native.concat, t, separator, first, last)
  if not ok then fail("table.concat: %s", text) end
  return text
end
-- outside of 1 … #t + 1 the native function would iterate over all integers between
function T.insert(...)
  local t, at, value = ...
  check_table(t, "table.insert")
  local given = select("#", ...)
  if given == 2 then return native.insert(t, at) end
  if given ~= 3 then fail("table.insert takes a table, a place if it is not the end, and a value") end
  if type(at) ~= "number" or not (at >= 1 and at <= #t + 1) then
    fail("table.insert: the place is 1 … %d here, not %s", #t + 1, describe(at))
  end
  native.insert(t, at, value)
end
T.remove, T.maxn = native.remove, native.maxn

-- nested coroutines use up the C stack
local depth = 0
P.on_failure[#P.on_failure + 1] = function() depth = 0 end
local function leave(...)
  depth = depth - 1
  return ...
end
local function resume(co, ...)
  if type(co) ~= "thread" then fail("coroutine.resume takes a coroutine, not %s", describe(co)) end
  if depth >= 100 then fail("coroutines are nested more than 100 deep") end
  depth = depth + 1
  return leave(native.resume(co, ...))
end
local function unwrap(ok, ...)
  if not ok then error(..., 0) end
  return ...
end
local function create(f)
  P.check_function(f, "coroutine.create")
  return native.create(f)
end
local C = { create = create, resume = resume, status = coroutine.status, running = coroutine.running,
  yield = coroutine.yield }
function C.wrap(f)
  local co = create(f)
  return function(...) return unwrap(resume(co, ...)) end
end

local function copy(lib)
  local t = {}
  for name, f in pairs(lib) do t[name] = f end
  return t
end
function P.make_table() return copy(T) end
function P.make_coroutine() return copy(C) end

-- pairs in a fixed order: numbers, texts in alphabetical order, false and true, objects in stream order
local function by_order(a, b) return a.order < b.order end
local function add_objects(keys, objects)
  for i, object in ipairs(objects) do
    objects[i] = { object = object, order = api.order(ctx, object.slot_, object.generation_) }
  end
  P.sort(objects, by_order)
  for _, entry in ipairs(objects) do keys[#keys + 1] = entry.object end
end
-- A loop over `next` itself has special instructions, and LuaJIT of 2022 ends it too early after its compilation
-- failed.
local function key_after(t, key) return (next(t, key)) end
local function gather_keys(t)
  local numbers, texts, flags, objects, sorted, last = {}, {}, {}, {}, true, -math.huge
  for key in key_after, t do
    local kind = type(key)
    if kind == "number" then
      numbers[#numbers + 1], sorted, last = key, sorted and key > last, key
    elseif kind == "string" then
      texts[#texts + 1] = key
    elseif kind == "boolean" then
      flags[key and 2 or 1] = key
    elseif P.class_of(key) then
      objects[#objects + 1] = key
    else
      fail("pairs: a key of this table is a %s, which can't be put in a fixed order; use numbers, text or objects",
        kind)
    end
  end
  if not sorted then P.sort(numbers) end
  P.sort(texts)
  for _, key in ipairs(texts) do numbers[#numbers + 1] = key end
  for i = 1, 2 do
    if flags[i] ~= nil then numbers[#numbers + 1] = flags[i] end
  end
  if #objects > 0 then add_objects(numbers, objects) end
  return numbers
end
local function next_existing(keys, t, i)
  while keys[i] ~= nil and rawget(t, keys[i]) == nil do i = i + 1 end
  return i
end
local function next_pair(iteration)
  local keys, t, i = iteration.keys, iteration.t, iteration.i + 1
  local key = keys[i]
  if key ~= nil and rawget(t, key) == nil then
    i = next_existing(keys, t, i)
    key = keys[i]
  end
  iteration.i = i
  if key == nil then return nil end
  return key, rawget(t, key)
end
function P.pairs(t)
  if istype(P.L, t) or istype(P.S, t) or istype(P.F, t) then return P.ipairs(t) end
  if type(t) ~= "table" then fail("pairs takes a table, not %s", describe(t)) end
  return next_pair, { t = t, keys = gather_keys(t), i = 0 }
end
