-- `params`: a scene's own parameters, properties of the node /scene.
local P = ...
local ffi, api, ctx, answer = P.ffi, P.api, P.ctx, P.answer
local fail, describe = P.fail, P.describe
local kNumber, kBoolean, kChoice, kVec3 = 0, 2, 3, 4  -- PropertyType of properties/property_table.h

local class, node  -- of the declared parameters
local initial, low, high = ffi.new("double[4]"), ffi.new("double[4]"), ffi.new("double[4]")
local keys = { min = true, max = true, step = true, unit = true, doc = true, choices = true, rerun = true }

local function put(to, value, subject, name)
  if type(value) == "number" then
    if value ~= value then fail("params: '%s': %s is not a number", name, subject) end
    to[0], to[1], to[2] = value, value, value
  else
    local v = P.as_vec3(value) or fail("params: '%s': %s is a number or a vec3, not %s", name, subject, describe(value))
    to[0], to[1], to[2] = v.x, v.y, v.z
  end
end

local function type_of(spec, name)
  local default = spec[2]
  if type(default) == "number" then return kNumber end
  if type(default) == "boolean" then return kBoolean end
  if P.as_vec3(default) then return kVec3 end
  if type(default) == "string" then return kChoice end
  fail("params: '%s' needs a default that is a number, true or false, a vec3, or text with choices, not %s", name,
    describe(default))
end

local function check_spec(spec, i)
  if type(spec) ~= "table" then
    fail("params: entry %d is a table { \"name\", default, … }, not %s", i, describe(spec))
  end
  local name = spec[1]
  if type(name) ~= "string" or not name:find("^[%a_][%w_]*$") or #name > 64 then
    fail("params: entry %d begins with a name of letters, digits and _, not %s", i, describe(name))
  end
  for key in pairs(spec) do
    if key ~= 1 and key ~= 2 and not keys[key] then
      fail("params: '%s' has no '%s'%s", name, tostring(key), P.hint(key, P.sorted_keys(keys)))
    end
  end
  for _, key in ipairs { "unit", "doc" } do
    if spec[key] ~= nil then P.check_text(spec[key], "params: '" .. name .. "': " .. key) end
  end
  if spec.step ~= nil and P.check_number(spec.step, "params: '" .. name .. "': step") <= 0 then
    fail("params: '%s': step is above 0", name)
  end
  if spec.rerun ~= nil and type(spec.rerun) ~= "boolean" then
    fail("params: '%s': rerun is true or false, not %s", name, describe(spec.rerun))
  end
  return name
end

local function choices_of(spec, name)
  local choices, at = spec.choices, nil
  if type(choices) ~= "table" or #choices == 0 then
    fail("params: '%s' is text, so it needs choices = { … }", name)
  end
  for i, choice in ipairs(choices) do
    P.check_text(choice, "params: '" .. name .. "': a choice")
    if choice == spec[2] then at = i end
  end
  if not at then fail("params: '%s': the default %s is none of its choices%s", name, describe(spec[2]),
    P.hint(spec[2], choices)) end
  return choices, at - 1
end

local function declare_one(spec, i)
  local name = check_spec(spec, i)
  local kind, choices = type_of(spec, name), {}
  put(low, -math.huge, "min", name)
  put(high, math.huge, "max", name)
  if kind == kNumber or kind == kVec3 then
    put(initial, spec[2], "the default", name)
    if spec.min ~= nil then put(low, spec.min, "min", name) end
    if spec.max ~= nil then put(high, spec.max, "max", name) end
    for k = 0, 2 do P.check_number(initial[k], "params: '" .. name .. "'") end
  elseif kind == kBoolean then
    put(low, 0)
    put(high, 1)
    initial[0] = spec[2] and 1 or 0
  else
    choices, initial[0] = choices_of(spec, name)
    put(low, 0)
    put(high, #choices - 1)
  end
  P.handle_result(api.param_property(ctx, name, #name, kind, initial, low, high))
  for _, choice in ipairs(choices) do api.param_choice(ctx, choice, #choice) end
  if spec.doc then api.param_doc(ctx, spec.doc, #spec.doc) end
  if spec.step then api.param_step(ctx, spec.step) end
  if spec.rerun then api.param_rerun(ctx) end
  if spec.unit then P.handle_result(api.param_unit(ctx, spec.unit, #spec.unit)) end
end

-- passes a list of declarations, of the scene or of a behavior, to the API
function P.collect_params(list)
  if type(list) ~= "table" then fail("params takes a list of { \"name\", default, … }, not %s", describe(list)) end
  local unknown_keys = {}
  for key in pairs(list) do
    if type(key) ~= "number" or key % 1 ~= 0 or key < 1 or key > #list then
      unknown_keys[#unknown_keys + 1] = tostring(key)
    end
  end
  table.sort(unknown_keys)
  local first = unknown_keys[1]
  if first then fail("params: '%s' is not an entry of the list; write { \"%s\", … }", first, first) end
  api.param_begin(ctx)
  for i, spec in ipairs(list) do declare_one(spec, i) end
end

local function declare(_, list)
  P.needs_top_level("params")
  P.needs_scene("params")
  if node then fail("params is called once, with all parameters of the scene") end
  P.collect_params(list)
  if api.param_done(ctx) ~= 0 then fail("%s", P.text()) end
  class = { name = "params", table = answer.count, getters = {}, setters = {}, methods = {}, properties = {} }
  node = { slot_ = answer.slot, generation_ = answer.generation }
  P.derive_members(class)
end

-- looks up the node's id after the node was replaced
function P.update_params_node()
  if not node then return end
  api.params_node(ctx)
  node.slot_, node.generation_ = answer.slot, answer.generation
end

-- in an earlier run: switches to the parameters of the live run
function P.update_params()
  if not node then return end
  local exists = api.params_node(ctx) == 0
  node.slot_, node.generation_ = exists and answer.slot or -1, exists and answer.generation or 0
  if exists and answer.count == class.table then return end
  for _, members in ipairs { class.getters, class.setters, class.methods, class.properties } do
    for key in pairs(members) do members[key] = nil end
  end
  class.table = exists and answer.count or -1
  if exists then P.derive_members(class) end
end

function P.parameter_names() return class and class.getters or {} end

local function no_parameter(key)
  fail("params has no '%s'%s", tostring(key), P.hint(key, P.sorted_keys(P.parameter_names())))
end

P.params = setmetatable({}, {
  __call = declare,
  __index = function(_, key)
    local get = class and class.getters[key]
    if not get then no_parameter(key) end
    return get(node)
  end,
  __newindex = function(_, key, value)
    local set = class and class.setters[key]
    if not set then no_parameter(key) end
    P.needs_callback("setting params." .. key)
    set(node, value)
  end,
  __tostring = function() return "params" end,
  __metatable = "params",
})
