-- Behaviors: attaching them to one or several bodies, and their handles. Each type has a table of its own, so its class
-- is created on first use.
local P = ...
local ffi, api, ctx, answer, istype = P.ffi, P.api, P.ctx, P.answer, P.ffi.istype
local fail, describe, classes = P.fail, P.describe, P.classes
local body, sim = classes.body, classes.sim
local parts, joints, motors, behaviors, groups = 1, 2, 3, 5, 6

local function type_name(h)
  if api.behavior_text(ctx, h.slot_, h.generation_, 0) ~= 0 then P.fail_removed(h) end
  return P.text()
end

local function error_text(h)
  local code = api.behavior_text(ctx, h.slot_, h.generation_, 1)
  if code == -2 then P.fail_removed(h) end
  if code == 0 then return P.text() end
  return nil
end

local function list(kind) return function(h) return (P.list_of(h, kind)) end end

local function derive_class(class)
  P.derive_members(class)
  P.add_common_members(class)
  class.getters.type = type_name
  if class.name == "behavior" then
    class.getters.body = P.owner_of
    class.getters.error = error_text
    class.getters.parts, class.getters.joints, class.getters.motors = list(parts), list(joints), list(motors)
  end
end

-- creates the class for a table number: of a type's instances, or of its groups
function P.make_class(number)
  api.table_name(ctx, number)
  local class = { name = P.text(), table = number, getters = {}, setters = {}, methods = {}, properties = {},
    ctype = ffi.typeof("struct { const int32_t slot_, generation_; }") }
  P.add_class(class)
  derive_class(class)
  P.finish_class(class)
  return class
end

-- derives the members of a class again after its table has changed
function P.update_class(class)
  for _, members in ipairs { class.getters, class.setters, class.methods, class.properties, class.members } do
    for key in pairs(members) do members[key] = nil end
  end
  derive_class(class)
  P.fill_members(class)
end

-- Selection of targets: a name, a pattern, "all", an object, or a list of these; passed to the API word by word.
local function select_one(of, kind, one, subject)
  if type(one) == "string" then return api.select_word(ctx, of, one, #one) end
  local class = P.class_of(one)
  if not class or class.name ~= kind then
    fail("%s takes names, patterns, %ss or \"all\", not %s", subject, kind, describe(one))
  end
  P.slot_of(one)
  local name = P.names[one]
  api.select_word(ctx, of, name, #name)
end
local function select(of, kind, wanted, subject)
  if wanted == nil then return end
  if istype(P.L, wanted) then wanted = P.items_of(wanted) end
  if type(wanted) ~= "table" then return select_one(of, kind, wanted, subject) end
  api.select_none(ctx, of)
  for _, one in ipairs(wanted) do select_one(of, kind, one, subject) end
end

-- rejects objects of other bodies, which would otherwise be confused with own ones of the same name
local function check_owner(h, wanted, subject)
  if wanted == nil or type(wanted) == "string" then return end
  if istype(P.L, wanted) then wanted = P.items_of(wanted) end
  for _, one in ipairs(type(wanted) == "table" and wanted or { wanted }) do
    if P.class_of(one) and P.class_of(one).name ~= "body" and one.body ~= h then
      fail("%s: %s does not belong to %s", subject, P.label(one), P.label(h))
    end
  end
end

local function class_of_type(kind, group)
  P.require_behavior_type(kind)
  P.handle_result(api.behavior_type(ctx, kind, #kind, group))
  return P.class_of_table(answer.count)
end

local own = { parts = true, joints = true, motors = true }
body.methods.add_behavior = function(h, kind, name, opts)
  local subject = "add_behavior"
  P.check_self(h, body, subject)
  P.check_text(kind, subject .. ": the type")
  P.check_text(name, subject .. ": the name")
  local class = class_of_type(kind, 0)
  P.check_opts(class, opts, own, subject)
  api.select_clear(ctx)
  if opts then
    for key in pairs(own) do check_owner(h, opts[key], subject .. ": " .. key) end
    select(0, "part", opts.parts, subject .. ": parts")
    select(1, "joint", opts.joints, subject .. ": joints")
    select(2, "motor", opts.motors, subject .. ": motors")
  end
  local code = api.add_behavior(ctx, h.slot_, h.generation_, kind, #kind, name, #name)
  return P.finish_creation(code, class, opts, own, h)
end
body.getters.behaviors = list(behaviors)
body.methods.behavior = function(h, key)
  P.check_self(h, body, "behavior")
  return (P.find_in(h, behaviors, key))
end

local group_own = { bodies = true, parts = true, neighbor_parts = true }
sim.methods.add_group_behavior = function(h, kind, name, opts)
  local subject = "add_group_behavior"
  P.check_self(h, sim, subject)
  P.check_text(kind, subject .. ": the type")
  P.check_text(name, subject .. ": the name")
  local class = class_of_type(kind, 1)
  P.check_opts(class, opts, group_own, subject)
  api.select_clear(ctx)
  if opts then
    select(3, "body", opts.bodies, subject .. ": bodies")
    select(0, "part", opts.parts, subject .. ": parts")
    select(4, "part", opts.neighbor_parts, subject .. ": neighbor_parts")
  end
  return P.finish_creation(api.add_group(ctx, kind, #kind, name, #name), class, opts, group_own)
end
sim.methods.group_behavior = function(h, key)
  P.check_self(h, sim, "group_behavior")
  return (P.find_in(h, groups, key))
end
