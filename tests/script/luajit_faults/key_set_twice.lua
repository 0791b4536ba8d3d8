-- A key of a new table that is set twice has its first value if compiled code continues from other compiled code.
local out = ...
local side
local function make(number)
  local t = {}
  t.key = false
  t.key = number == number
  if side then end
  return t.key
end
local function call()  -- the closure prevents its own compilation
  local _ = function() end
  local result = make(0)
  return result
end
for _ = 1, 200 do call() end
side = true
for _ = 1, 200 do call() end
out(call())
