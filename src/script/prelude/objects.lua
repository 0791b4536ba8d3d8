-- Objects: one handle per node that a script has accessed, and the members of its class, derived from the properties of
-- its table. Stored properties are read directly from the store's memory after a check of the generation.
local P = ...
local ffi, api, ctx, answer, view = P.ffi, P.api, P.ctx, P.answer, P.view
local fail, describe, text = P.fail, P.describe, P.text
local V, Q, F, istype, format = P.V, P.Q, P.F, P.ffi.istype, string.format

local classes, by_table, by_ctype = {}, {}, {}
P.classes = classes
function P.add_class(class) by_table[class.table], by_ctype[tonumber(class.ctype)] = class, class end
-- each behavior type has a table of its own; its class is created on first use (behaviors/handles.lua)
local function class_of_table(number) return by_table[number] or P.make_class(number) end
P.class_of_table = class_of_table
-- the classes of c_api's class_table, in its order
P.class_names = { "sim", "body", "part", "joint", "motor", "shape", "visuals", "camera", "look", "gear", "imu",
  "range_finder", "zone", "touch", "tendon", "fixture", "mocap", "mocap_joint", "route", "clock" }
for i, name in ipairs(P.class_names) do
  local class = { name = name, ctype = ffi.typeof(name), getters = {}, setters = {}, methods = {}, properties = {} }
  class.number = i - 1
  classes[name], by_ctype[tonumber(class.ctype)] = class, class
end
-- table of the node of a valid handle; for behaviors and groups the table of their type
local handles = {}
local function each_class_in_use(f)
  for slot, h in pairs(handles) do
    if slot < view.slot_count and view.slots[slot].generation == h.generation_ then
      f(by_ctype[tonumber(ffi.typeof(h))], view.slots[slot].table)
    end
  end
end

-- each store numbers its tables independently
function P.number_classes()
  for table in pairs(by_table) do by_table[table] = nil end
  for _, class in pairs(classes) do
    class.table = api.class_table(ctx, class.number)
    by_table[class.table] = class
  end
  each_class_in_use(function(class, number)
    if class.number then return end
    class.table = number
    by_table[number] = by_table[number] or class
  end)
end
P.number_classes()

-- after parameters of behavior types may have changed: updates each class to the table of its handles
function P.update_classes()
  each_class_in_use(function(class, number)
    if class.number or class.table == number then return end
    if by_table[class.table] == class then by_table[class.table] = nil end
    by_table[number] = by_table[number] or class
    class.table = number
    P.update_class(class)
  end)
end
-- names of singletons in error messages
classes.sim.only, classes.visuals.only, classes.clock.only = "sim", "visuals", "sim.clock"
classes.camera.only, classes.look.only = "visuals.camera", "visuals.look"

-- Handles: one for each slot, so that an object is always the same table key. Names remain after an object is removed.
local names = setmetatable({}, { __mode = "k" })
local owners = setmetatable({}, { __mode = "k" })
P.names, P.handles = names, handles

local handle_of
local function create_handle(slot, generation)
  local class = class_of_table(view.slots[slot].table)
  local h = class.ctype(slot, generation)
  api.name(ctx, slot, generation)
  names[h] = text()
  api.owner(ctx, slot, generation)
  if answer.count ~= 0 then owners[h] = handle_of(answer.slot, answer.generation) end
  handles[slot] = h  -- last, because a script may be stopped at any line
  return h
end

-- returns the handle of an id
function handle_of(slot, generation)
  local h = handles[slot]
  if h and h.generation_ == generation then return h end
  return create_handle(slot, generation)
end
P.handle_of = handle_of

-- the handle of the last answer, or nil if it had none
function P.answered_handle()
  if answer.count == 0 then return nil end
  return (handle_of(answer.slot, answer.generation))
end

-- adds a class of handles; sets name and owner of a handle
function P.add_handles(class) by_ctype[tonumber(class.ctype)] = class end
function P.register_handle(h, name, owner) names[h], owners[h] = name, owner end

local function class_of(value)
  return type(value) == "cdata" and by_ctype[tonumber(ffi.typeof(value))] or nil
end
P.class_of = class_of

local function label(h)
  local class = class_of(h)
  if not class or class.only then return class and class.only or "params" end
  local owner = owners[h]
  return format("%s '%s%s'", class.name, owner and names[owner] .. "/" or "", names[h])
end
P.label = label

local function alive(h)
  local slot = h.slot_
  return slot >= 0 and slot < view.slot_count and view.slots[slot].generation == h.generation_
end
P.alive = alive

local function fail_removed(h) fail("%s no longer exists (check its .alive)", label(h)) end
P.fail_removed = fail_removed

-- the slot of an existing object; error if it was removed
local function slot_of(h)
  local slot = h.slot_
  if not (slot >= 0 and slot < view.slot_count) then fail_removed(h) end
  local s = view.slots[slot]
  if s.generation ~= h.generation_ then fail_removed(h) end
  return s
end
P.slot_of = slot_of

function P.check_self(h, class, method)
  if not istype(class.ctype, h) then
    fail("%s is a method of a %s: write it with a colon, %s:%s(…), not with a dot", method, class.name, class.name,
      method)
  end
  slot_of(h)
end

-- PropertyType and PropertyKind of properties/property_table.h, as far as used here
local kBoolean, kChoice, kVec3, kFlags3, kQuat, kText = 2, 3, 4, 5, 6, 8
local kReadout, kAction = 2, 3

-- returns the getter of a property: by type, from the transient or persistent block, or through the API if computed
local function getter_of(property)
  local offset, is_transient, choices, kind = property.offset, property.transient, property.choices, property.type
  local make
  if kind == kVec3 then
    make = function(v, i) return (V(v[i], v[i + 1], v[i + 2])) end
  elseif kind == kQuat then
    make = function(v, i) return (Q(v[i], v[i + 1], v[i + 2], v[i + 3])) end
  elseif kind == kFlags3 then
    make = function(v, i) return (F(v[i] ~= 0, v[i + 1] ~= 0, v[i + 2] ~= 0)) end
  elseif kind == kBoolean then
    make = function(v, i) return v[i] ~= 0 end
  elseif kind == kChoice then
    make = function(v, i) return choices[v[i] + 1] end
  else
    make = function(v, i) return v[i] end
  end
  if property.computed then
    local index = property.index
    return function(h)
      if api.get(ctx, h.slot_, h.generation_, index) ~= 0 then fail_removed(h) end
      return (make(answer.number, 0))
    end
  end
  if is_transient then return function(h) return (make(view.transient, slot_of(h).transient + offset)) end end
  return function(h) return (make(view.persistent, slot_of(h).persistent + offset)) end
end

local function fail_type(h, property, value, expected)
  fail("%s: '%s' takes %s, not %s", label(h), property.name, expected, describe(value))
end

local function set_three(property)
  local index, own = property.index, property.own_axis
  return function(h, value)
    local code
    if istype(V, value) then
      code = api.set3(ctx, h.slot_, h.generation_, index, value.x, value.y, value.z)
    elseif own and type(value) == "number" then
      code = api.set_own(ctx, h.slot_, h.generation_, index, value)
    else
      local v = P.as_vec3(value) or
        fail_type(h, property, value, own and "a vec3, or one number for the own axis" or "a vec3")
      code = api.set3(ctx, h.slot_, h.generation_, index, v.x, v.y, v.z)
    end
    if code ~= 0 then P.handle_result(code, fail_removed, h) end
  end
end

local function set_flags(property)
  local index = property.index
  local function number(h, value, flag)
    if type(flag) ~= "boolean" then fail_type(h, property, value, "three booleans, or one for all axes") end
    return flag and 1 or 0
  end
  return function(h, value)
    local x, y, z
    if type(value) == "boolean" then
      x, y, z = value, value, value
    elseif istype(F, value) then
      x, y, z = value.x, value.y, value.z
    elseif type(value) == "table" and #value == 3 then
      x, y, z = value[1], value[2], value[3]
    end
    local code = api.set3(ctx, h.slot_, h.generation_, index, number(h, value, x), number(h, value, y),
      number(h, value, z))
    if code ~= 0 then P.handle_result(code, fail_removed, h) end
  end
end

-- returns the setter of a property: checks the type, then calls the API
local function setter_of(property)
  local index, kind = property.index, property.type
  if kind == kVec3 then return set_three(property) end
  if kind == kFlags3 then return set_flags(property) end
  if kind == kQuat then
    return function(h, q)
      if not istype(Q, q) then fail_type(h, property, q, "a quat") end
      local code = api.set4(ctx, h.slot_, h.generation_, index, q.x, q.y, q.z, q.w)
      if code ~= 0 then P.handle_result(code, fail_removed, h) end
    end
  elseif kind == kBoolean then
    return function(h, value)
      if type(value) ~= "boolean" then fail_type(h, property, value, "true or false") end
      local code = api.set1(ctx, h.slot_, h.generation_, index, value and 1 or 0)
      if code ~= 0 then P.handle_result(code, fail_removed, h) end
    end
  elseif kind == kChoice then
    return function(h, value)
      if type(value) ~= "string" then
        fail_type(h, property, value, "one of '" .. table.concat(property.choices, "' '") .. "'")
      end
      local code = api.set_choice(ctx, h.slot_, h.generation_, index, value, #value)
      if code ~= 0 then P.handle_result(code, fail_removed, h) end
    end
  end
  return function(h, value)
    if type(value) ~= "number" then fail_type(h, property, value, "a number") end
    local code = api.set1(ctx, h.slot_, h.generation_, index, value)
    if code ~= 0 then P.handle_result(code, fail_removed, h) end
  end
end

-- returns the method of an action: converts vec3s and numbers to the action's numbers
local numbers = ffi.new("double[16]")
local function method_of(class, property)
  local index, name, ctype = property.index, property.name, class.ctype
  local function put(h, n, value)
    if type(value) == "number" and n < 16 then
      numbers[n] = value
      return n + 1
    end
    local v = P.as_vec3(value)
    if not v or n > 13 then fail("%s: '%s' takes vec3s, not %s", label(h), name, describe(value)) end
    numbers[n], numbers[n + 1], numbers[n + 2] = v.x, v.y, v.z
    return n + 3
  end
  return function(h, a, b, c, d, e, f)
    if not istype(ctype, h) then P.check_self(h, class, name) end
    if answer.top_level ~= 0 then P.needs_callback(label(h) .. ":" .. name) end
    local n = 0
    if istype(V, a) and b == nil then
      numbers[0], numbers[1], numbers[2], n = a.x, a.y, a.z, 3
    elseif a ~= nil then
      n = put(h, n, a)
      if b ~= nil then n = put(h, n, b) end
      if c ~= nil then n = put(h, n, c) end
      if d ~= nil then n = put(h, n, d) end
      if e ~= nil then n = put(h, n, e) end
      if f ~= nil then n = put(h, n, f) end
    end
    local code = api.act(ctx, h.slot_, h.generation_, index, numbers, n)
    if code ~= 0 then P.handle_result(code, fail_removed, h) end
  end
end

-- derives a class's members from the properties of its table
function P.derive_members(class)
  for i = 0, api.property_count(ctx, class.table) - 1 do
    local r = api.property(ctx, class.table, i)
    local property = { index = i, name = ffi.string(r.name, r.length), type = r.type, kind = r.kind,
      transient = r.transient ~= 0, computed = r.computed ~= 0, offset = r.offset, own_axis = r.own_axis ~= 0,
      writable = r.writable ~= 0, choices = {} }
    for c = 0, r.choices - 1 do
      api.property_choice(ctx, class.table, i, c)
      property.choices[c + 1] = text()
    end
    class.properties[property.name] = property
    if property.kind == kAction then
      class.methods[property.name] = method_of(class, property)
    elseif property.type ~= kText then  -- getters of texts are written by hand
      class.getters[property.name] = getter_of(property)
      if property.writable then class.setters[property.name] = setter_of(property) end
    end
  end
end

local function member_names(class)
  local list = {}
  for _, members in ipairs { class.getters, class.methods } do
    for _, key in ipairs(P.sorted_keys(members)) do list[#list + 1] = key end
  end
  return list
end
P.member_names = member_names

local function no_member(h, class, key)
  fail("%s has no property '%s'%s", label(h), tostring(key), P.hint(key, member_names(class)))
end

local function not_writable(h, class, key)
  if class.methods[key] then fail("%s: '%s' is a method: call it with a colon, it can't be set", label(h), key) end
  local property = class.properties[key]
  if property and property.kind == kReadout then
    fail("%s: '%s' is a readout: it can be read, not set", label(h), key)
  end
  if class.getters[key] then fail("%s: '%s' can be read, not set", label(h), key) end
  no_member(h, class, key)
end
P.not_writable = not_writable

-- Methods have the entry false to distinguish them from unknown names, because compiled code finds existing keys faster
-- than missing ones.
function P.fill_members(class)
  for key in pairs(class.methods) do class.members[key] = false end
  for key, get in pairs(class.getters) do class.members[key] = get end
end

-- sets the metatable of a class's handles, once all of its members are known
function P.finish_class(class)
  local getters, setters, methods, ctype = class.getters, class.setters, class.methods, class.ctype
  local members = {}
  class.members = members
  P.fill_members(class)
  ffi.metatype(ctype, {
    __index = function(h, key)
      local get = members[key]
      if get == nil then get = getters[key] end  -- added later
      if get then
        local value = get(h)  -- no tail call: a getter must return to a Lua function to be compiled
        return value
      end
      return methods[key] or no_member(h, class, key)
    end,
    __newindex = function(h, key, value)
      local set = setters[key]
      if not set then return not_writable(h, class, key) end
      set(h, value)
    end,
    __eq = function(a, b)
      return istype(ctype, a) and istype(ctype, b) and a.slot_ == b.slot_ and a.generation_ == b.generation_
    end,
    __tostring = label,
    __call = function()
      fail("this is a %s, not a function: use a dot for members, a colon only for methods", class.name)
    end,
  })
end

-- members of all objects
function P.add_common_members(class)
  class.getters.alive = alive
  class.getters.name = function(h)
    slot_of(h)
    return names[h]
  end
end

-- sets properties from an opts table in a fixed order; `own`: keys that were used for the creation itself
function P.check_opts(class, opts, own, subject)
  if opts == nil then return end
  if type(opts) ~= "table" then fail("%s: opts is a table, not %s", subject, describe(opts)) end
  for key in pairs(opts) do
    if type(key) ~= "string" or not (own[key] or class.setters[key]) then
      local known = P.sorted_keys(own)
      for _, name in ipairs(P.sorted_keys(class.setters)) do known[#known + 1] = name end
      fail("%s: opts has no '%s'%s", subject, tostring(key), P.hint(key, known))
    end
  end
end
function P.apply_opts(h, class, opts, own)
  if opts == nil then return h end
  for _, key in ipairs(P.sorted_keys(opts)) do
    if not own[key] then class.setters[key](h, opts[key]) end
  end
  return h
end
