-- Loops with a step of -0, and from or to NaN.
local out = ...
local nan, minus = 0 / 0, -0
local function rounds(first, last, step)
  local n = 0
  for _ = first, last, step do
    n = n + 1
    if n > 3 then break end
  end
  return n
end
local sum = { 0, 0, 0, 0 }
for i = 1, 200 do
  sum[1] = sum[1] + rounds(1, 2, minus)
  sum[2] = sum[2] + rounds(nan, 2, 1)
  sum[3] = sum[3] + rounds(1, nan, 1)
  sum[4] = sum[4] + rounds(1, 2, nan)
  sum[1] = sum[1] + rounds(1, i % 3, 1)
end
out(sum[1], sum[2], sum[3], sum[4])
