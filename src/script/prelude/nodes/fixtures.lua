-- Lighting fixtures.
local P = ...
local api, ctx, answer, classes = P.api, P.ctx, P.answer, P.classes
local fail, describe, handle_of = P.fail, P.describe, P.handle_of
local ffi = P.ffi
local fixtures = 10  -- kind of list
local part, fixture = classes.part, classes.fixture
local method = P.sim_method

P.derive_members(fixture)
P.add_common_members(fixture)
fixture.getters.targets = function(h)
  P.slot_of(h)
  local list, i = {}, 0
  while true do
    local code = api.fixture_target(ctx, h.slot_, h.generation_, i)
    if code == -1 then return list end
    if code == 0 then list[#list + 1] = handle_of(answer.slot, answer.generation) end
    i = i + 1
  end
end
for which, name in pairs { [0] = "profile", "dmx" } do
  fixture.getters[name] = function(h)
    if api.fixture_text(ctx, h.slot_, h.generation_, which) ~= 0 then P.fail_removed(h) end
    return (P.text())
  end
end
P.finish_class(fixture)

local own = { profile = true, targets = true, universe = true, address = true }
local max_targets = 64

-- the slots and generations of the parts that a fixture can aim at
local function targets_of(value)
  if value == nil then return ffi.new("double[1]"), 0 end
  local list = P.class_of(value) == part and { value } or value
  if type(list) ~= "table" then
    fail("add_fixture: targets is a part or a list of parts, not %s", describe(value))
  end
  if #list > max_targets then fail("add_fixture: targets has at most %d parts, not %d", max_targets, #list) end
  local numbers = ffi.new("double[?]", 2 * math.max(#list, 1))
  for i, target in ipairs(list) do
    if P.class_of(target) ~= part then
      fail("add_fixture: target %d is a part, as body:part(name), not %s", i, describe(target))
    end
    P.slot_of(target)
    numbers[2 * i - 2], numbers[2 * i - 1] = target.slot_, target.generation_
  end
  return numbers, #list
end

method("add_fixture", function(h, key, opts)
  P.check_text(key, "add_fixture: the name")
  P.check_opts(fixture, opts, own, "add_fixture")
  opts = opts or {}
  if opts.profile == nil then
    fail('add_fixture: profile is the name of a profile, such as "moving_spot", or a file, such as "spot.fixture"')
  end
  local profile = P.check_text(opts.profile, "add_fixture: profile")
  local function number(name)
    return opts[name] == nil and 0 / 0 or P.check_number(opts[name], "add_fixture: " .. name)
  end
  local targets, count = targets_of(opts.targets)
  local code = api.add_fixture(ctx, key, #key, profile, #profile, number("universe"), number("address"), targets, count)
  return P.finish_creation(code, fixture, opts, own, h)
end)
method("fixture", function(h, key) return P.find_in(h, fixtures, key) end)
classes.sim.getters.fixtures = function(h) return P.list_of(h, fixtures) end
