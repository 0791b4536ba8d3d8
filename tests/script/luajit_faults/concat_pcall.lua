-- pcall as the metamethod for `..` crashes.
local out = ...
local object = setmetatable({}, { __call = function(self) return self end, __concat = pcall })
local good = 0
for _ = 1, 300 do
  if (object .. object .. "") == true then good = good + 1 end
end
out(good)
