-- math.min and math.max of 0, -0 and NaN depend on whether they are compiled.
local out = ...
local zero, minus, nan, sum = 0, -0, 0 / 0, ""
for i = 1, 200 do
  local a, b = zero, minus
  if i % 3 == 0 then a, b = minus, zero elseif i % 3 == 1 then a, b = 1, nan end
  local low, high = math.min(a, b), math.max(a, b)
  sum = sum .. (low ~= low and "n" or 1 / low < 0 and "-" or "+") .. (high ~= high and "n" or 1 / high < 0 and "-" or "+")
end
out(sum)
