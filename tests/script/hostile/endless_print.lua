-- __tostring never ends, called by print.
-- expect: 3: stopped after
local t = setmetatable({}, { __tostring = function() while true do end end })
sim:on_step(function() print(t) end)
