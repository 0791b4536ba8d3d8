-- Motion capture: sources, their joints, and bodies that follow them.
local P = ...
local api, ctx, answer, number, classes = P.api, P.ctx, P.answer, P.answer.number, P.classes
local fail, describe, handle_of = P.fail, P.describe, P.handle_of
local mocaps, joints = 11, 12  -- kinds of lists
local mocap, joint, sim = classes.mocap, classes.mocap_joint, classes.sim
local method = P.sim_method

for _, class in ipairs { mocap, joint } do
  P.derive_members(class)
  P.add_common_members(class)
end
joint.getters.mocap = P.owner_of
joint.getters.parent = function(h)
  if api.mocap_bone(ctx, h.slot_, h.generation_) ~= 0 then P.fail_removed(h) end
  return (P.answered_handle())
end
joint.getters.length = function(h)
  if api.mocap_bone(ctx, h.slot_, h.generation_) ~= 0 then P.fail_removed(h) end
  return number[0]
end
mocap.getters.joints = function(h) return (P.list_of(h, joints)) end
P.finish_class(joint)

-- the numbers of the options in mocap_option
local file, dialect, dancer, up, handed, quaternion, expected, address, words, parent, child = 0, 1, 2, 3, 4, 5, 6, 7,
  8, 9, 10
local function option(which, value, subject)
  P.check_text(value, subject)
  api.mocap_option(ctx, which, value, #value)
end

local units = { m = 1, cm = 0.01, mm = 0.001, ["in"] = 0.0254, ft = 0.3048 }
local function set_unit(unit)
  local meters = type(unit) == "number" and unit or units[unit]
  if type(meters) ~= "number" or not (meters >= 1e-6 and meters <= 1e6) then
    fail("add_mocap: unit is 'm', 'cm', 'mm', 'in', 'ft', or a number of meters, not %s", describe(unit))
  end
  api.mocap_number(ctx, 0, meters)
end

local function set_source(opts)
  local source = opts.source
  if opts.messages ~= nil and opts.dancer ~= nil then
    fail("add_mocap: dancer has no effect on messages; remove it, and write it in their addresses")
  end
  if source == nil and opts.messages ~= nil then return end
  P.check_text(source, "add_mocap: source (a .bvh file, 'osc', 'psn' or 'vmc')")
  if source:lower():find("%.bvh$") then
    if opts.messages ~= nil or opts.dancer ~= nil then
      fail("add_mocap: a file has no messages and no dancer; remove one or the other")
    end
    if opts.joints ~= nil or opts.bones ~= nil then fail("add_mocap: a file has joints and bones of its own; remove them") end
    return option(file, source, "add_mocap: source")
  end
  if source == "osc" and opts.messages ~= nil then return end
  local psn = source:find("^psn") ~= nil
  if (source == "vmc" or psn) and opts.messages ~= nil then
    fail("add_mocap: %s has messages of its own; remove source or messages", psn and "PosiStageNet" or "VMC")
  end
  if source == "vmc" and opts.dancer ~= nil then fail("add_mocap: VMC has no dancer; give each its own port") end
  if psn and opts.dancer ~= nil then fail("add_mocap: PosiStageNet has no dancer; its trackers are the joints") end
  option(dialect, source, "add_mocap: source")
end

local function set_messages(messages)
  if type(messages) ~= "table" then
    fail("add_mocap: messages is a table { [\"/address\"] = \"x y z\" }, not %s", describe(messages))
  end
  for _, key in ipairs(P.sorted_keys(messages)) do
    option(address, key, "add_mocap: messages, an address")
    option(words, messages[key], "add_mocap: messages, " .. key)
  end
end

local function set_bones(bones)
  if type(bones) ~= "table" then
    fail("add_mocap: bones is a list of { parent, child }, not %s", describe(bones))
  end
  for i, bone in ipairs(bones) do
    local subject = "add_mocap: bone " .. i
    if type(bone) ~= "table" then fail("%s is a list { parent, child }, not %s", subject, describe(bone)) end
    option(parent, bone[1], subject .. ": the parent")
    option(child, bone[2], subject .. ": the child")
    if bone[3] ~= nil then
      local length = P.check_number(bone[3], subject .. ": the length")
      if length <= 0 or length > 100 then fail("%s: the length is above 0 and at most 100 m, not %g", subject, length) end
      api.mocap_number(ctx, 1, length)
    end
  end
end

local own = { source = true, dancer = true, messages = true, joints = true, bones = true, up = true, handed = true,
  unit = true, quaternion = true }
method("add_mocap", function(_, name, opts)
  P.needs_top_level("sim:add_mocap")
  P.check_text(name, "add_mocap: the name")
  if type(opts) ~= "table" then
    fail("add_mocap takes a table such as { source = \"dancer.bvh\" }, not %s", describe(opts))
  end
  P.check_opts(mocap, opts, own, "add_mocap")
  api.mocap_begin(ctx)
  set_source(opts)
  if opts.messages ~= nil then set_messages(opts.messages) end
  if opts.unit ~= nil then set_unit(opts.unit) end
  local key = opts.dancer
  if type(key) == "number" then key = string.format("%d", key) end
  if key ~= nil then option(dancer, key, "add_mocap: dancer") end
  for key, which in pairs { up = up, handed = handed, quaternion = quaternion } do
    if opts[key] ~= nil then option(which, opts[key], "add_mocap: " .. key) end
  end
  if opts.joints ~= nil and type(opts.joints) ~= "table" then
    fail("add_mocap: joints is a list of names, not %s", describe(opts.joints))
  end
  for i, key in ipairs(opts.joints or {}) do option(expected, key, "add_mocap: joint " .. i) end
  if opts.bones ~= nil then set_bones(opts.bones) end
  return P.finish_creation(api.add_mocap(ctx, name, #name), mocap, opts, own)
end)
method("mocap", function(h, key) return P.find_in(h, mocaps, key) end)
sim.getters.mocaps = function(h) return (P.list_of(h, mocaps)) end

mocap.methods.joint = function(h, key)
  P.check_self(h, mocap, "joint")
  if type(key) == "string" then
    P.handle_result(api.mocap_expect(ctx, h.slot_, h.generation_, key, #key), P.fail_removed, h)
    return (handle_of(answer.slot, answer.generation))
  end
  return (P.find_in(h, joints, key))
end

-- a kinematic capsule for each bone, and a ball for a joint without a parent
local body_own = { radius = true }
mocap.methods.add_body = function(h, name, opts)
  local subject = "add_body"
  P.check_self(h, mocap, subject)
  P.check_text(name, subject .. ": the name")
  P.check_opts(classes.body, opts, body_own, subject)
  local radius = P.check_number(opts and opts.radius or 0.04, subject .. ": radius")
  if radius <= 0 or radius > 10 then fail("%s: radius is above 0 and at most 10 m, not %g", subject, radius) end
  local list = P.items_of(P.list_of(h, joints))
  if #list == 0 then
    fail("%s: %s has no joints yet; list them with joints or bones", subject, P.label(h))
  end
  local body = P.sim:add_body(name, { self_collision = false })
  for _, each in ipairs(list) do
    local length = each.parent and each.length * h.scale or 0
    local key = name .. "_" .. each.name
    local shape = length > 1e-6 and P.sim:add_capsule_shape(key, radius, length) or
      P.sim:add_sphere_shape(key, length > 0 and radius or 1.5 * radius)
    body:add_part(each.name, shape, { mass = 0, position = each.position }).motion = "kinematic"
  end
  body:add_behavior("mocap_body", "mocap", { parts = "*", source = h.number })
  return P.apply_opts(body, classes.body, opts, body_own)
end
P.finish_class(mocap)
