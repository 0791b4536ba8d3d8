-- A bounds check is omitted for a table that is replaced by an empty one.
local out = ...
local function play()
  local s, t, n = { nil, nil, nil, nil }, {}, 0
  for i = 1, 2 do
    if i ~= 1 then
      for k = -0, i do
        if k ~= 0 then
          s[k] = nil
          s = {}
          n = n + 1
        end
      end
    end
  end
  return n
end
local sum = 0
for _ = 1, 500 do sum = sum + play() end
out(sum)
