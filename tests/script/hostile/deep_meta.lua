-- A recursive metamethod.
-- expect: 3-4: stack overflow
local t t = setmetatable({}, { __index = function(_, k) return t[k] end })
sim:on_step(function() return t.x end)
