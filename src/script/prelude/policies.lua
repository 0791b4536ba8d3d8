-- Policies: networks from files, which compute actions from observations.
local P = ...
local ffi, api, ctx, answer = P.ffi, P.api, P.ctx, P.answer
local fail, describe, istype = P.fail, P.describe, P.ffi.istype

-- Observations, actions and hidden values are arrays in Lua's memory: a rewind restores them with it.
local policies = {}
local Policy = ffi.typeof("policy")
local members = { inputs = 1, outputs = 1, evaluate = 1, reset = 1 }
P.value_members.policy = members
local methods = {}

local function policy_of(self, method)
  if not istype(Policy, self) then fail("policy.%s is a method: write policy:%s(…)", method, method) end
  return policies[self.number_]
end

function methods.evaluate(self, observations, actions)
  local policy = policy_of(self, "evaluate")
  if type(observations) ~= "table" then
    fail("policy:evaluate takes a list of observations, not %s", describe(observations))
  end
  if actions == nil then
    actions = {}
  elseif type(actions) ~= "table" then
    fail("policy:evaluate: the second argument is a table for the actions, not %s", describe(actions))
  end
  local count, numbers, results = policy.inputs, policy.observations, policy.actions
  for i = 1, count do
    local x = observations[i]
    if type(x) ~= "number" then
      fail("policy:evaluate: observation %d of %d is a number, not %s", i, count, describe(x))
    end
    numbers[i - 1] = x
  end
  if observations[count + 1] ~= nil then
    fail("policy:evaluate: %s takes %d observations, not %d", policy.label, count, #observations)
  end
  if api.evaluate_policy(ctx, self.number_, numbers, policy.hidden, results) ~= 0 then
    fail("policy:evaluate: %s: %s", policy.label, P.text())
  end
  for i = 1, policy.outputs do actions[i] = results[i - 1] end
  return actions
end

function methods.reset(self)
  local policy = policy_of(self, "reset")
  ffi.fill(policy.hidden, policy.hidden_count * 4)
end

local function index(self, key)
  local method = methods[key]
  if method then return method end
  if key == "inputs" or key == "outputs" then return policies[self.number_][key] end
  fail("policy has no member '%s'%s", tostring(key), P.hint(key, P.sorted_keys(members)))
end
ffi.metatype(Policy, {
  __index = index,
  __newindex = function() fail("policy has nothing to set") end,
  __tostring = function(self) return policies[self.number_].label end,
})

P.sim_method("load_policy", function(_, file)
  P.needs_top_level("sim:load_policy")
  P.needs_scene("sim:load_policy")
  P.check_text(file, "load_policy: the file")
  P.handle_result(api.load_policy(ctx, file, #file))
  local number = answer.count
  local inputs, outputs, hidden = answer.number[0], answer.number[1], answer.number[2]
  policies[number] = {
    label = "policy '" .. file .. "'",
    inputs = inputs,
    outputs = outputs,
    observations = ffi.new("double[?]", inputs),
    actions = ffi.new("double[?]", outputs),
    hidden = ffi.new("float[?]", math.max(1, hidden)),
    hidden_count = hidden,
  }
  return (Policy(number))
end)
