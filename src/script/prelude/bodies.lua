-- Members of bodies, parts, joints, motors and shapes that are not properties.
local P = ...
local ffi, api, ctx, answer, istype = P.ffi, P.api, P.ctx, P.answer, P.ffi.istype
local fail, classes = P.fail, P.classes
local body, part, joint, motor, shape = classes.body, classes.part, classes.joint, classes.motor, classes.shape
local bodies, parts, joints, motors, shapes = 0, 1, 2, 3, 4
local number = answer.number

for _, name in ipairs { "body", "part", "joint", "motor", "shape" } do
  P.derive_members(classes[name])
  P.add_common_members(classes[name])
end
P.add_mass_members(part)

local function related(which)
  return function(h)
    if api.related(ctx, h.slot_, h.generation_, which) ~= 0 then P.fail_removed(h) end
    return (P.answered_handle())
  end
end
local function owner(h)
  P.slot_of(h)
  api.owner(ctx, h.slot_, h.generation_)
  return (P.answered_handle())
end
local function list(kind) return function(h) return (P.list_of(h, kind)) end end

P.owner_of = owner
for _, class in ipairs { part, joint, motor } do class.getters.body = owner end
part.getters.shape = related(0)
joint.getters.parent, joint.getters.child, joint.getters.motor = related(0), related(1), related(2)

-- A motor's joint never changes, so it is looked up once and cached by the motor's slot. If the slot is reused by
-- another motor, the old joint was removed as well, unless the creation of the old motor was rolled back.
local joint_of = {}
local query_joint = related(0)
motor.getters.joint = function(h)
  P.slot_of(h)
  local joint = joint_of[h.slot_]
  if joint == nil or not P.alive(joint) then
    joint = query_joint(h)
    joint_of[h.slot_] = joint
  end
  return joint
end
-- called when slots may belong to other objects: clears the cache
function P.clear_relations() joint_of = {} end
P.on_failure[#P.on_failure + 1] = P.clear_relations

body.getters.root = related(0)
body.getters.parts, body.getters.joints, body.getters.motors = list(parts), list(joints), list(motors)
joint.getters.type = function(h)
  if api.joint_type(ctx, h.slot_, h.generation_) ~= 0 then P.fail_removed(h) end
  return P.text()
end

local function method(class, name, f)
  class.methods[name] = function(h, ...)
    P.check_self(h, class, name)
    return f(h, ...)
  end
end

for name, kind in pairs { part = parts, joint = joints, motor = motors } do
  body.methods[name] = function(h, key)
    if not istype(body.ctype, h) then P.check_self(h, body, name) end
    return (P.find_in(h, kind, key))
  end
end

-- completes a creation: checks the result, then sets the properties from opts
local function finish_creation(code, class, opts, own, h)
  if code ~= 0 then P.handle_result(code, P.fail_removed, h) end
  return P.apply_opts(P.answered_handle(), class, opts, own)
end
P.finish_creation = finish_creation

local pose = ffi.new("double[7]")
-- position and rotation of an opts table as seven numbers; `missing` is used for omitted values
function P.pose_of(opts, subject, missing)
  local p, q = opts and opts.position, opts and opts.rotation
  for i = 0, 6 do pose[i] = missing or 0 end
  if not missing then pose[6] = 1 end
  if p ~= nil then
    p = P.check_vec3(p, subject .. ": position")
    pose[0], pose[1], pose[2] = P.check_number(p.x, subject), P.check_number(p.y, subject), P.check_number(p.z, subject)
  end
  if q ~= nil then
    q = P.check_quat(q, subject .. ": rotation")
    if q.x == 0 and q.y == 0 and q.z == 0 and q.w == 0 then fail("%s: quat(0, 0, 0, 0) is not a rotation", subject) end
    pose[3], pose[4] = P.check_number(q.x, subject), P.check_number(q.y, subject)
    pose[5], pose[6] = P.check_number(q.z, subject), P.check_number(q.w, subject)
  end
  return pose
end

local function shape_named(key) return (P.find_in(P.sim, shapes, key)) end

local part_own = { mass = true, position = true, rotation = true }
method(body, "add_part", function(h, name, of_shape, opts)
  local subject = "add_part"
  P.check_text(name, subject .. ": the name")
  of_shape = shape_named(of_shape)
  P.check_opts(part, opts, part_own, subject)
  local mass = opts and opts.mass
  if mass ~= nil and P.check_number(mass, subject .. ": mass") < 0 then
    fail("%s: mass must not be negative (0: a part that never moves)", subject)
  end
  local code = api.add_part(ctx, h.slot_, h.generation_, name, #name, of_shape.slot_, of_shape.generation_,
    mass or -1, P.pose_of(opts, subject, 0 / 0))
  return finish_creation(code, part, opts, part_own, h)
end)

local joint_own = { type = true, position = true, axis = true }
local frame = ffi.new("double[6]")
method(body, "add_joint", function(h, name, parent, child, opts)
  local subject = "add_joint"
  P.check_text(name, subject .. ": the name")
  parent, child = P.find_in(h, parts, parent), P.find_in(h, parts, child)
  P.check_opts(joint, opts, joint_own, subject)
  opts = opts or {}
  local kind = P.check_text(opts.type or "revolute", subject .. ": type")
  local position = P.check_vec3(opts.position or child.position, subject .. ": position")
  local axis = P.check_vec3(opts.axis or { 0, 0, 1 }, subject .. ": axis")
  frame[0], frame[1], frame[2] = position.x, position.y, position.z
  frame[3], frame[4], frame[5] = axis.x, axis.y, axis.z
  for i = 0, 5 do P.check_number(frame[i], subject) end
  local code = api.add_joint(ctx, h.slot_, h.generation_, name, #name, kind, #kind, parent.slot_, child.slot_, frame)
  return finish_creation(code, joint, opts, joint_own, h)
end)

method(body, "add_motor", function(h, of_joint, opts)
  of_joint = P.find_in(h, joints, of_joint)
  P.check_opts(motor, opts, {}, "add_motor")
  return finish_creation(api.add_motor(ctx, of_joint.slot_, of_joint.generation_), motor, opts, {}, of_joint)
end)

method(body, "copy", function(h, name, opts)
  P.check_text(name, "copy: the name")
  P.check_opts(body, opts, {}, "copy")
  return finish_creation(api.copy_body(ctx, h.slot_, h.generation_, name, #name), body, opts, {}, h)
end)

-- pairs of parts that don't collide
local function edit_pair(name, edit)
  method(body, name, function(h, a, b)
    a, b = P.find_in(h, parts, a), P.find_in(h, parts, b)
    local code = api.edit_pair(ctx, h.slot_, h.generation_, a.slot_, a.generation_, b.slot_, b.generation_, edit)
    P.handle_result(code, P.fail_removed, h)
  end)
end
edit_pair("exclude_pair", 1)
edit_pair("include_pair", 2)
body.getters.excluded_pairs = function(h)
  if api.excluded_pair(ctx, h.slot_, h.generation_, -1) ~= 0 then P.fail_removed(h) end
  local pairs_of_parts = {}
  for i = 1, number[0] do
    api.excluded_pair(ctx, h.slot_, h.generation_, i - 1)
    local a, b = number[0], number[1]
    api.list_item(ctx, h.slot_, h.generation_, parts, a)
    local first = P.answered_handle()
    api.list_item(ctx, h.slot_, h.generation_, parts, b)
    pairs_of_parts[i] = { first, P.answered_handle() }
  end
  return pairs_of_parts
end

-- collision groups: a bit mask, or names that the scene assigns to bits
P.collision_groups = {}
local function group_bits(h, property, value)
  if type(value) == "number" then return value end
  if type(value) == "string" then value = { value } end
  if type(value) ~= "table" then
    fail("%s: '%s' takes a number, a name of sim.collision_groups, or a list of names, not %s", P.label(h), property,
      P.describe(value))
  end
  local bits = {}
  for _, name in ipairs(value) do
    local found
    for i, known in ipairs(P.collision_groups) do
      if known == name then found = i end
    end
    if not found then
      if #P.collision_groups == 0 then
        fail("%s: '%s' can't take names yet; name the groups first: sim.collision_groups = { 'robot', 'floor' }",
          P.label(h), property)
      end
      fail("%s: sim.collision_groups has no '%s'%s", P.label(h), tostring(name),
        P.hint(tostring(name), P.collision_groups))
    end
    bits[found] = true
  end
  local sum = 0
  for i in pairs(bits) do sum = sum + 2 ^ (i - 1) end
  return sum
end
for _, property in ipairs { "collision_group", "collision_mask" } do
  local set = part.setters[property]
  part.setters[property] = function(h, value) set(h, group_bits(h, property, value)) end
end

method(body, "bounds", function(h)
  local code = api.body_bounds(ctx, h.slot_, h.generation_)
  if code == -1 then return nil end -- it has no shape
  if code ~= 0 then P.fail_removed(h) end
  return P.V(number[0], number[1], number[2]), P.V(number[3], number[4], number[5])
end)

method(body, "state_hash", function(h)
  api.state_hash(ctx, h.slot_, h.generation_)
  return P.text()
end)

-- a link of the model, including merged ones; identified by its name
local K = ffi.typeof("link")
local links = {}
method(body, "link", function(h, name)
  P.check_text(name, "body:link")
  P.handle_result(api.link_pose(ctx, h.slot_, h.generation_, name, #name), P.fail_removed, h)
  for _, known in ipairs(links) do
    if known.body == h and known.name == name then return known.handle end
  end
  local link = { body = h, name = name, handle = K(h.slot_, h.generation_, #links + 1) }
  links[#links + 1] = link
  return link.handle
end)

function P.each_link(f)
  for _, link in ipairs(links) do f(link) end
end

local function link_pose(k)
  local link = links[k.number_]
  local code = api.link_pose(ctx, k.slot_, k.generation_, link.name, #link.name)
  if code ~= 0 then P.handle_result(code, P.fail_removed, link.body) end
end
local link_members = {
  name = function(k) return links[k.number_].name end,
  body = function(k) return links[k.number_].body end,
  alive = function(k) return P.alive(links[k.number_].body) end,
  position = function(k)
    link_pose(k)
    return P.V(number[0], number[1], number[2])
  end,
  rotation = function(k)
    link_pose(k)
    return P.Q(number[3], number[4], number[5], number[6])
  end,
}
local function link_label(k)
  local link = links[k.number_]
  return string.format("link '%s/%s'", P.names[link.body], link.name)
end
ffi.metatype(K, {
  __index = function(k, key)
    local get = link_members[key]
    if get then return get(k) end
    fail("%s has no member '%s'%s", link_label(k), tostring(key), P.hint(key, P.sorted_keys(link_members)))
  end,
  __newindex = function(k, key) fail("%s: '%s' can be read, not set", link_label(k), tostring(key)) end,
  __tostring = link_label,
})

method(shape, "add_child", function(h, child, position, rotation)
  child = shape_named(child)
  local code = api.add_child(ctx, h.slot_, h.generation_, child.slot_, child.generation_,
    P.pose_of({ position = position, rotation = rotation }, "add_child"))
  P.handle_result(code, P.fail_removed, h)
  return h
end)

for _, name in ipairs { "body", "part", "joint", "motor", "shape" } do P.finish_class(classes[name]) end
