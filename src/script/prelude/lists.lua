-- Lists in stream order: #arm.motors, arm.motors[1], ipairs(arm.motors), for motor in arm:motors("left_*") do.
local P = ...
local ffi, api, ctx, answer = P.ffi, P.api, P.ctx, P.answer
local fail, describe, handle_of, alive, istype = P.fail, P.describe, P.handle_of, P.alive, P.ffi.istype

local L = ffi.typeof("list")
P.L = L
local kinds = { [0] = { name = "body", list = "bodies" }, { name = "part", list = "parts" },
  { name = "joint", list = "joints" }, { name = "motor", list = "motors" }, { name = "shape", list = "shapes" },
  { name = "behavior", list = "behaviors" }, { name = "group", list = "groups" },
  { name = "gear", list = "gears" }, { name = "sensor", list = "sensors" },
  { name = "tendon", list = "tendons" }, { name = "fixture", list = "fixtures" },
  { name = "mocap", list = "mocaps" }, { name = "mocap_joint", list = "joints" },
  { name = "route", list = "routes" } }

-- the contents of a list are collected on first use and cached until the structure of the world changes
local entries = { [0] = {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {} }

local function gather(list, entry)
  local slot, generation, kind = list.slot_, list.generation_, list.kind_
  local owner = handle_of(slot, generation)
  P.slot_of(owner)
  local count, items = api.list_count(ctx, slot, generation, kind), {}
  if count < 0 then P.fail_removed(owner) end
  for i = 0, count - 1 do
    api.list_item(ctx, slot, generation, kind, i)
    items[i + 1] = handle_of(answer.slot, answer.generation)
  end
  -- set the version last, because a script may be stopped at any line
  entry.items, entry.matched = items, {}
  entry.version = api.structure(ctx)
  return entry
end

local function entry_of(list)
  local entry = entries[list.kind_][list.slot_]
  if entry.version == api.structure(ctx) and entry.generation == list.generation_ then return entry end
  if entry.generation ~= list.generation_ then fail("the body of this list no longer exists") end
  return (gather(list, entry))
end

local function items_of(list) return entry_of(list).items end
P.items_of = items_of

-- the list of an object; always the same list object
function P.list_of(owner, kind)
  P.slot_of(owner)
  local slot = owner.slot_
  local entry = entries[kind][slot]
  if not entry or entry.generation ~= owner.generation_ then
    entry = { generation = owner.generation_, version = -1, list = L(slot, owner.generation_, kind) }
    entries[kind][slot] = entry
  end
  return entry.list
end

function P.each_list(f)
  for kind = 0, #entries do
    for _, entry in pairs(entries[kind]) do f(entry) end
  end
end

-- updates the lists after their handles got other ids
function P.reindex_lists()
  for kind = 0, #entries do
    local moved = {}
    for _, entry in pairs(entries[kind]) do
      local list = entry.list
      entry.generation, entry.version, entry.items = list.generation_, -1, nil
      if list.slot_ >= 0 then moved[list.slot_] = entry end
    end
    entries[kind] = moved
  end
end

-- finds an object by name, by number (−1: the last), or returns the object itself after a check
function P.find_in(owner, kind, key)
  if type(key) == "string" then
    local code = api.find(ctx, owner.slot_, owner.generation_, kind, key, #key)
    if code ~= 0 then P.handle_result(code, P.fail_removed, owner) end
    return (handle_of(answer.slot, answer.generation))
  end
  if type(key) == "number" then
    local items = items_of(P.list_of(owner, kind))
    local found = items[key < 0 and #items + 1 + key or key]
    if found then return found end
    fail("%s has %d %s; there is no %s", P.label(owner), #items, kinds[kind].list, tostring(key))
  end
  local class = P.class_of(key)
  if not class or (class.kind or class.name) ~= kinds[kind].name then
    fail("expected the name or number of a %s, not %s", kinds[kind].name, describe(key))
  end
  P.slot_of(key)
  local of = P.class_of(owner).name == "behavior" and owner.body or owner
  if (kind > 0 and kind < 4 or kind == 5 or kind == 8) and key.body ~= of then
    fail("%s does not belong to %s", P.label(key), P.label(owner))
  end
  return key
end

-- adds the objects that match one word to `chosen`
local function choose(list, items, chosen, word)
  if word == "all" then
    for _, item in ipairs(items) do chosen[item] = true end
  elseif type(word) == "string" and api.is_pattern(ctx, word, #word) ~= 0 then
    for _, item in ipairs(items) do
      local name = P.names[item]
      if api.matches(ctx, word, #word, name, #name) ~= 0 then chosen[item] = true end
    end
  else
    chosen[P.find_in(handle_of(list.slot_, list.generation_), list.kind_, word)] = true
  end
end

local function select_uncached(list, entry, selector)
  local chosen, result = {}, {}
  if type(selector) == "table" then
    for _, word in ipairs(selector) do choose(list, entry.items, chosen, word) end
  else
    choose(list, entry.items, chosen, selector)
  end
  for _, item in ipairs(entry.items) do
    if chosen[item] then result[#result + 1] = item end
  end
  if type(selector) == "string" then entry.matched[selector] = result end
  return result
end

-- Returns the objects that match a name, a pattern, an object, a list of these or "all", without duplicates, in stream
-- order. Has no closures or loops, which would prevent the compilation of a surrounding loop.
local function select_from(list, entry, selector)
  if selector == nil then return entry.items end
  return type(selector) == "string" and entry.matched[selector] or select_uncached(list, entry, selector)
end

local function next_alive(items, i)
  while items[i] and not alive(items[i]) do i = i + 1 end
  return i
end

-- one iteration step; skips objects that have been removed meanwhile
local function step(iteration)
  local items, i = iteration.items, iteration.i + 1
  local item = items[i]
  if item and not alive(item) then
    i = next_alive(items, i)
    item = items[i]
  end
  iteration.i = i
  if not item then return nil end
  iteration.count = iteration.count + 1
  return item, iteration.count
end

ffi.metatype(L, {
  __index = function(list, key)
    if type(key) == "number" then return items_of(list)[key] end
    local kind = kinds[list.kind_]
    fail("a list of %s has no member '%s'; a %s is found by %s:%s(name) or by a number in [ ]", kind.list,
      tostring(key), kind.name, kind.name == "body" and "sim" or "body", kind.name)
  end,
  __newindex = function(list) fail("the list of %s is read-only", kinds[list.kind_].list) end,
  __len = function(list) return #items_of(list) end,
  __eq = function(a, b)
    return istype(L, a) and istype(L, b) and a.slot_ == b.slot_ and a.generation_ == b.generation_ and
      a.kind_ == b.kind_
  end,
  __call = function(list, self, selector)
    local class = P.class_of(self)
    if not class or self.slot_ ~= list.slot_ then
      local name = kinds[list.kind_].list
      fail("to iterate over %s use a colon: for x in object:%s(…) do", name, name)
    end
    local entry = entry_of(list)
    return step, { items = select_from(list, entry, selector), i = 0, count = 0 }
  end,
  __tostring = function(list) return "list of " .. kinds[list.kind_].list end,
})

-- ipairs that also accepts lists and flags
local native_ipairs = ipairs
function P.ipairs(t)
  if istype(L, t) then t = items_of(t) end
  if istype(P.F, t) then return native_ipairs { t.x, t.y, t.z } end
  local f, s, i = native_ipairs(t)
  return f, s, i
end
