-- `...` read after a call of a recursive function gives wrong values.
local out = ...
local function fact(n) return n <= 1 and 1 or n * fact(n - 1) end
local function second(...)
  fact(20)
  local _, value = ...
  return value
end
local wrong = 0
for _ = 1, 2000 do
  if second(1, 2, 3) ~= 2 then wrong = wrong + 1 end
end
out(wrong)
