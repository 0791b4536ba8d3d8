-- __newindex is not called if two variables refer to one table.
local out = ...
local count = 0
local function play(a, b)
  count = 0
  local meta = { __newindex = function(t, k, v)
    count = count + 1
    rawset(t, k, v)
  end }
  setmetatable(a, meta)
  setmetatable(b, meta)
  for _ = 1, 200 do
    a[10] = 1
    b[10] = nil
    a[10] = 1
    b[10] = 1
  end
  return count
end
local large = {}
for i = 1, 65536 do large[-i] = true end
play({}, large)
local small = {}
out(play(small, small))
