-- `...` read in a loop gives wrong values once the loop is compiled.
local out = ...
local function mean(...)
  local sum = 0
  for _ = 1, 1000 do
    local first = ...
    sum = sum + first
  end
  return sum / 1000
end
out(mean(1, 2, 3))
