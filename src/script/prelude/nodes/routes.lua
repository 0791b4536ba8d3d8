-- Routes.
local P = ...
local api, ctx = P.api, P.ctx
local fail, describe = P.fail, P.describe
local route, sim = P.classes.route, P.classes.sim
local routes = 13  -- kind of list

P.derive_members(route)
P.add_common_members(route)
for which, name in pairs { [0] = "from", "to", "problem" } do
  route.getters[name] = function(h)
    if api.route_text(ctx, h.slot_, h.generation_, which) ~= 0 then P.fail_removed(h) end
    return (P.text())
  end
end
P.finish_class(route)

-- the address of an end: text, or { object, "property" }
local function address_of(value, subject)
  if type(value) == "string" then return value end
  local object = type(value) == "table" and value[1]
  if not object or not P.class_of(object) then
    fail('%s is an address, or { object, "property" }, not %s', subject, describe(value))
  end
  P.check_text(value[2], subject .. ": the property")
  P.slot_of(object)
  if api.node_path(ctx, object.slot_, object.generation_) ~= 0 then P.fail_removed(object) end
  return P.text() .. "/" .. value[2]
end

local function add_range(settings, name, range)
  if range == nil then return false end
  if type(range) ~= "table" then fail("add_route: %s is two numbers { low, high }, not %s", name, describe(range)) end
  settings[name .. "_low"] = P.check_number(range[1], "add_route: the lower end of " .. name)
  settings[name .. "_high"] = P.check_number(range[2], "add_route: the upper end of " .. name)
  return true
end

local own = { from = true, to = true, input = true, output = true }
sim.methods.add_route = function(_, name, opts)
  P.check_text(name, "add_route: the name")
  P.check_opts(route, opts, own, "add_route")
  opts = opts or {}
  local from = address_of(opts.from, "add_route: from")
  local to = address_of(opts.to, "add_route: to")
  local settings = {}
  for key, value in pairs(opts) do
    if not own[key] then settings[key] = value end
  end
  local has_input = add_range(settings, "input", opts.input)
  local has_output = add_range(settings, "output", opts.output)
  if settings.clamp == nil and (has_input or has_output) then settings.clamp = true end
  local code = api.add_route(ctx, name, #name, from, #from, to, #to)
  return P.finish_creation(code, route, settings, own, P.sim)
end
sim.methods.route = function(h, key) return P.find_in(h, routes, key) end
sim.getters.routes = function(h) return P.list_of(h, routes) end
