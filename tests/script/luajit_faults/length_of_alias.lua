-- `#t` in a loop ignores elements appended through another variable.
local out = ...
local t, sum = {}, 0
local alias = t
for i = 1, 1000 do
  alias[i] = i
  sum = sum + #t
end
out(sum)
