-- A metamethod for `..` with `...` crashes.
local out = ...
local object = setmetatable({}, { __concat = function(...)
  local _, second = ...
  return second
end })
local same = 0
for i = 1, 300 do
  local text = i
  if ("a" .. "b" .. object) == object and (text .. "b" .. object) == object then same = same + 1 end
end
out(same)
