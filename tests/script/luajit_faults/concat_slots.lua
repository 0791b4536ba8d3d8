-- Concatenating several texts after an object with a metamethod uses wrong operands.
local out = ...
local object = setmetatable({}, { __concat = function(_, right) return right end })
local function join()
  local result
  for _ = 1, 200 do result = object .. "" .. "" .. "" .. "" .. "text" end
  return result
end
out(pcall(join))
out(pcall(join))
