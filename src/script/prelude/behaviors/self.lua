-- `self` of a behavior written in Lua: a handle of a class with the type's parameters and the members of every
-- behavior; and the entries for calling its functions.
local P = ...
local ffi, api, ctx, answer = P.ffi, P.api, P.ctx, P.answer
local fail, describe, istype = P.fail, P.describe, P.ffi.istype
local native_ipairs = ipairs

-- All tables are indexed by the instance's number. Data used in most steps have separate tables, because with thousands
-- of instances each memory access counts.
local instances = {}  -- handle, type, body, state, rng
local group_of = {}   -- slot of the group's node
local kinds = { parts = 1, joints = 2, motors = 3 }
local lists_of = { parts = {}, joints = {}, motors = {}, neighbor_parts = {} }
P.group_of = group_of

local function instance_of(h) return instances[h.number_] or P.fail_removed(h) end

-- Lists of `self`: collected on first use and cached until start() is called again.
local S = ffi.typeof("struct { const int32_t number_; }")
local lists, list_names, free = {}, {}, {}
P.S = S

local function gather(h, kind)
  local items = {}
  local count = api.behavior_item(ctx, h.slot_, h.generation_, kind, -1)
  if count < 0 then P.fail_removed(h) end
  for i = 0, count - 1 do
    api.behavior_item(ctx, h.slot_, h.generation_, kind, i)
    items[i + 1] = P.handle_of(answer.slot, answer.generation)
  end
  return items
end

local function items_of(list) return lists[list.number_] or fail("this list is out of date: get it from self again") end

local function next_item(list, i)
  i = i + 1
  local item = lists[list.number_][i]
  if item then return i, item end
end

-- Lists with several items have an iterator of their own, which needs no lookup for each step and can't be modified by
-- scripts.
local iterators = {}
local function iterator_of(items)
  return function(_, i)
    i = i + 1
    local item = items[i]
    if item then return i, item end
  end
end

ffi.metatype(S, {
  __index = function(list, key)
    if type(key) == "number" then return items_of(list)[key] end
    fail("a list of %s has no member '%s'; an entry is found by a number in [ ]", list_names[list.number_], tostring(key))
  end,
  __newindex = function(list) fail("the list of %s is read-only", list_names[list.number_]) end,
  __len = function(list) return #items_of(list) end,
  __call = function(list)
    local name = list_names[list.number_]
    fail("%s is a list, not a function: for i, x in ipairs(self.%s) do", name, name)
  end,
  __tostring = function(list) return "list of " .. list_names[list.number_] end,
})

local ipairs_of_lists = P.ipairs
function P.ipairs(t)
  if istype(S, t) then return iterators[t.number_] or next_item, t, 0 end
  local f, s, i = ipairs_of_lists(t)
  return f, s, i
end

local function store_list(name, items)
  local number = #free > 0 and table.remove(free) or #lists + 1
  lists[number], list_names[number], iterators[number] = items, name, #items > 1 and iterator_of(items)
  return (S(number))
end

local function store_list_of(number, name, items)
  lists_of[name][number] = store_list(name, items)
  return lists_of[name][number]
end

local function drop_list(number, name)
  local list = lists_of[name][number]
  if not list then return end
  lists[list.number_], free[#free + 1], lists_of[name][number] = {}, list.number_, false
end

local function drop_lists(number)
  for name in pairs(lists_of) do drop_list(number, name) end
end

-- a group's neighbors change without a start of its members
local function neighbor_parts(h)
  local instance, number, version = instance_of(h), h.number_, api.structure(ctx)
  if not lists_of.neighbor_parts[number] or instance.structure ~= version then
    drop_list(number, "neighbor_parts")
    store_list_of(number, "neighbor_parts", P.neighbor_parts(h, instance.body))
    instance.structure = version
  end
  return lists_of.neighbor_parts[number]
end

function P.empty_list() return (store_list("warm", {})) end

-- members of every `self` besides its parameters
local getters = {
  name = function(h) return P.names[instance_of(h).handle] end,
  type = function(h) return instance_of(h).type.name end,
  body = function(h) return instance_of(h).body end,
  state = function(h) return instance_of(h).state end,
  rng = function(h) return instance_of(h).rng end,
  time = function() return P.sim.time end,
  alive = function(h) return P.alive(h) end,
}
for name in pairs(kinds) do
  local known = lists_of[name]
  getters[name] = function(h)
    return known[h.number_] or store_list_of(h.number_, name, instance_of(h) and gather(h, kinds[name]))
  end
end

local setters = {
  state = function(h, value)
    if type(value) ~= "table" then fail("%s: state is a table, not %s", P.label(h), describe(value)) end
    instance_of(h).state = value
  end,
}

local function no_interval(h, class, name)
  local property = class.properties[name]
  if property then
    fail("%s: '%s' is not a number of milliseconds; due takes the name of a number parameter", P.label(h), name)
  end
  local names = {}
  for _, key in native_ipairs(P.sorted_keys(class.setters)) do
    if class.properties[key] and class.properties[key].type == 0 then names[#names + 1] = key end
  end
  fail("%s: due takes the name of a parameter in quotes, not %s%s", P.label(h), describe(name), P.hint(name, names))
end

-- creates the class of a type's handles
function P.make_self(of)
  local ctype = ffi.typeof("struct { const int32_t slot_, generation_, number_; }")
  local class = { name = "behavior", table = of.table, ctype = ctype, getters = {}, setters = {}, methods = {},
    properties = {} }
  P.add_handles(class)
  P.derive_members(class)
  class.methods.remove = nil
  local intervals = {}  -- property indices by name, for due
  for name, property in pairs(class.properties) do
    if property.type == 0 and class.setters[name] then intervals[name] = property.index end
  end
  for name, get in pairs(getters) do class.getters[name] = get end
  for name, set in pairs(setters) do class.setters[name] = set end
  function class.methods.due(h, name)
    if not istype(ctype, h) then P.check_self(h, class, "due") end
    local property = intervals[name] or no_interval(h, class, name)
    local due = api.behavior_due(ctx, h.slot_, h.generation_, property)
    if due < 0 then P.fail_removed(h) end
    return due == 1
  end
  if of.is_group then
    P.add_neighbor_members(class)
    class.getters.neighbor_parts = neighbor_parts
  end
  P.finish_class(class)
  of.class = class
end

-- Called from C++: each start, step and migrate is a guarded call with a function and a handle from these tables,
-- indexed by the instance's number.
local exports = P.exports
local selfs, starts, steps, migrates = {}, {}, {}, {}
exports.behavior_self, exports.behavior_start = selfs, starts
exports.behavior_step, exports.behavior_migrate = steps, migrates

-- Steps many instances in one call; each is still guarded individually, from one behavior_next to the next. The loop is
-- compiled together with the steps, whereas a separate call from C++ would be interpreted up to its first loop.
function exports.step_behaviors(dt)
  local number = api.behavior_next(ctx)
  while number > 0 do
    steps[number](selfs[number], dt)
    number = api.behavior_next(ctx)
  end
end

function exports.make_behavior(file, slot, generation)
  local of = P.behavior_types[file]
  local number = #instances + 1
  local h = of.class.ctype(slot, generation, number)
  api.name(ctx, slot, generation)
  local name = P.text()
  api.behavior_body(ctx, slot, generation)
  local body = P.answered_handle()
  P.register_handle(h, name, body)
  instances[number] = { handle = h, type = of, body = body, state = {}, rng = P.R(slot, generation) }
  group_of[number] = of.is_group and api.behavior_group(ctx, slot, generation)
  for _, known in pairs(lists_of) do known[number] = false end  -- without gaps, so that the table stays an array
  selfs[number], starts[number], steps[number], migrates[number] = h, of.start, of.step, of.migrate
  return number
end

-- called before a start: the instance's targets may have changed
function exports.clear_behavior_lists(number) drop_lists(number) end

-- sets the state from text and returns it
function exports.restore_behavior(number, text)
  local state = P.plain_value(text)
  instances[number].state = state
  return state
end

-- accepts the result of migrate; if it is invalid returns text, file and line of the error
function exports.accept_migrated_state(number, state)
  local instance = instances[number]
  if type(state) == "table" then
    instance.state = state
    return nil
  end
  local file, line = instance.type.display_path, debug.getinfo(instance.type.migrate, "S").linedefined
  return string.format("%s:%d: %s: migrate returns the new state, a table, not %s", file, line,
    P.label(instance.handle), describe(state)), file, line
end

-- the state as text, or nil and the reason why it can't be serialized
local function reject(path, reason) error(string.format("%s %s; %s", path, reason, P.plain_kinds), 0) end
function exports.behavior_state(number)
  local ok, text = pcall(P.plain_text, instances[number].state, "state", reject)
  if ok then return text end
  return nil, text
end

function exports.drop_behavior(number)
  drop_lists(number)
  instances[number], selfs[number], steps[number] = false, false, false
end
