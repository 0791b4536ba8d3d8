-- A trained policy moves a leg: hip, thigh and knee follow its actions.
local policy = sim:load_policy("scripts/policies/trot.safetensors")
print(policy.inputs, policy.outputs) --> 5 3

local dog = sim:load_urdf("urdf/quadruped.urdf", { name = "dog", position = vec3(0, 0, 1), fixed_base = true })
local observations, actions = {}, {}
sim:on_start(function() policy:reset() end) -- needed for a network with a GRU only
sim:on_step(function()
  local phase = 2 * math.pi * 1.8 * sim.time
  observations[1], observations[2] = math.sin(phase), math.cos(phase) -- of the step
  observations[3], observations[4], observations[5] = 0, 0, 0 -- level trunk, front leg
  policy:evaluate(observations, actions)
  dog:motor("front_left_hip").target = actions[1]
  dog:motor("front_left_thigh").target = actions[2]
  dog:motor("front_left_knee").target = actions[3]
end)
sim:after(0.5, function()
  print(#actions, actions[2] == policy:evaluate(observations)[2]) --> 3 true
end)
