-- Behaviours: attaching them to a body or to several, and their handles. Each type has a table of its own, so a class is
-- made when the first node of it is met.
local P = ...
local ffi, api, ctx, answer, istype = P.ffi, P.api, P.ctx, P.answer, P.ffi.istype
local fail, describe, classes = P.fail, P.describe, P.classes
local body, sim = classes.body, classes.sim
local parts, joints, motors, behaviors, groups = 1, 2, 3, 5, 6

local function type_name(h)
  if api.behavior_text(ctx, h.slot_, h.generation_, 0) ~= 0 then P.gone(h) end
  return P.text()
end

local function error_text(h)
  local code = api.behavior_text(ctx, h.slot_, h.generation_, 1)
  if code == -2 then P.gone(h) end
  if code == 0 then return P.text() end
  return nil
end

local function list(kind) return function(h) return (P.list_of(h, kind)) end end

local function derive_class(class)
  P.derive(class)
  P.common(class)
  class.getters.type = type_name
  if class.name == "behavior" then
    class.getters.body = P.owner_of
    class.getters.error = error_text
    class.getters.parts, class.getters.joints, class.getters.motors = list(parts), list(joints), list(motors)
  end
end

-- the class of a table's number: of a type's instances, or of its groups
function P.make_class(number)
  api.table_name(ctx, number)
  local class = { name = P.text(), table = number, getters = {}, setters = {}, methods = {}, rows = {},
    ctype = ffi.typeof("struct { const int32_t slot_, generation_; }") }
  P.add_class(class)
  derive_class(class)
  P.finish(class)
  return class
end

-- the members of a class whose table is another one now
function P.renew_class(class)
  for _, members in ipairs { class.getters, class.setters, class.methods, class.rows, class.members } do
    for key in pairs(members) do members[key] = nil end
  end
  derive_class(class)
  P.fill_members(class)
end

-- what is meant: a name, a pattern, "all", a thing, a list of these; gathered word by word
local function select_one(of, kind, one, what)
  if type(one) == "string" then return api.select_word(ctx, of, one, #one) end
  local class = P.class_of(one)
  if not class or class.name ~= kind then
    fail("%s takes names, patterns, %ss or \"all\", not %s", what, kind, describe(one))
  end
  P.slot_of(one)
  local name = P.names[one]
  api.select_word(ctx, of, name, #name)
end
local function select(of, kind, wanted, what)
  if wanted == nil then return end
  if istype(P.L, wanted) then wanted = P.items_of(wanted) end
  if type(wanted) ~= "table" then return select_one(of, kind, wanted, what) end
  api.select_none(ctx, of)
  for _, one in ipairs(wanted) do select_one(of, kind, one, what) end
end

-- things of another body would be taken for its own of the same name
local function own_things(h, wanted, what)
  if wanted == nil or type(wanted) == "string" then return end
  if istype(P.L, wanted) then wanted = P.items_of(wanted) end
  for _, one in ipairs(type(wanted) == "table" and wanted or { wanted }) do
    if P.class_of(one) and P.class_of(one).name ~= "body" and one.body ~= h then
      fail("%s: %s does not belong to %s", what, P.label(one), P.label(h))
    end
  end
end

local function class_of_type(kind, group)
  P.need_behavior_type(kind)
  P.check(api.behavior_type(ctx, kind, #kind, group))
  return P.class_of_table(answer.count)
end

local own = { parts = true, joints = true, motors = true }
body.methods.add_behavior = function(h, kind, name, opts)
  local what = "add_behavior"
  P.check_self(h, body, what)
  P.want_text(kind, what .. ": the type")
  P.want_text(name, what .. ": the name")
  local class = class_of_type(kind, 0)
  P.check_opts(class, opts, own, what)
  api.select_clear(ctx)
  if opts then
    for key in pairs(own) do own_things(h, opts[key], what .. ": " .. key) end
    select(0, "part", opts.parts, what .. ": parts")
    select(1, "joint", opts.joints, what .. ": joints")
    select(2, "motor", opts.motors, what .. ": motors")
  end
  local code = api.add_behavior(ctx, h.slot_, h.generation_, kind, #kind, name, #name)
  return P.finish_making(code, class, opts, own, h)
end
body.getters.behaviors = list(behaviors)
body.methods.behavior = function(h, key)
  P.check_self(h, body, "behavior")
  return (P.find_in(h, behaviors, key))
end

local group_own = { bodies = true, parts = true, neighbor_parts = true }
sim.methods.add_group_behavior = function(h, kind, name, opts)
  local what = "add_group_behavior"
  P.check_self(h, sim, what)
  P.want_text(kind, what .. ": the type")
  P.want_text(name, what .. ": the name")
  local class = class_of_type(kind, 1)
  P.check_opts(class, opts, group_own, what)
  api.select_clear(ctx)
  if opts then
    select(3, "body", opts.bodies, what .. ": bodies")
    select(0, "part", opts.parts, what .. ": parts")
    select(4, "part", opts.neighbor_parts, what .. ": neighbor_parts")
  end
  return P.finish_making(api.add_group(ctx, kind, #kind, name, #name), class, opts, group_own)
end
sim.methods.group_behavior = function(h, key)
  P.check_self(h, sim, "group_behavior")
  return (P.find_in(h, groups, key))
end
