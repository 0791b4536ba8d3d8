-- A value of a new table that has outgrown its array is read from the old location.
local out = ...
local function values()
  local sum = 0
  for i = 6, 9 do
    local t = { i, i, i, i, i, i, i }
    t[i] = i
    t[1] = nil
    t[2] = nil
    t[3] = nil
    t[4] = nil
    t[5] = nil
    t["1000"] = 1000
    sum = sum + (t[i] or 0)
  end
  return sum
end
local function texts()
  local sum = 0
  for i = 6, 9 do
    local t = { 1, 2, 3, 4, 5, 6, 7, 8 }
    t[i] = "result"
    t[i + 1] = "result"
    t[1] = nil
    t[2] = nil
    t[3] = nil
    t[4] = nil
    t[5] = nil
    t[6] = nil
    t["1000"] = 1000
    if t[8] == 8 then sum = sum + 1 end
  end
  return sum
end
for _ = 1, 100 do out(values(), texts()) end
