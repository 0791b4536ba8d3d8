-- Policies.

---@page policies

---Loads a policy: a small neural network that computes actions from observations. The file is .safetensors or .onnx; it
---is found beside the scene, like a model. At the top level of the scene only. A save of the file reloads the scene.
---@param file string # The file, such as "walk.safetensors".
---@return policy
---@error sim:load_policy("absent.onnx") --> load_policy: there is no file 'absent.onnx'; looked for …
---@error sim:load_policy(3) --> load_policy: the file takes text, not 3
---@see policy:evaluate
---@example policies
function sim:load_policy(file) end

---A loaded policy. Each one has hidden values of its own, if its network has a GRU.
---@class policy
---@field inputs integer # read-only. Number of observations.
---@field outputs integer # read-only. Number of actions.
---@see sim:load_policy
---@example policies
local policy_ = {}

---Computes the actions. The same observations give the same bits on every machine. A network with a GRU replaces its
---hidden values: evaluate it once in each tick. If a number is not finite, nothing changes.
---@param observations number[] # `policy.inputs` numbers.
---@param actions? number[] # A table that gets the actions, so that a tick creates no new one.
---@return number[]
---@error sim:load_policy("scripts/policies/trot.safetensors"):evaluate { 1 } --> policy:evaluate: observation 2 of 5 is a number, not nothing
---@see policy:reset
---@example policies
function policy_:evaluate(observations, actions) end

---Sets the hidden values of a network with a GRU to 0, as at its start.
---@see policy:evaluate
---@example policies
function policy_:reset() end
