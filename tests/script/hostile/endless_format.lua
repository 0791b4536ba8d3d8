-- string.format calls a __tostring that never returns.
-- expect: 3: stopped after
local t = setmetatable({}, { __tostring = function() while true do end end })
sim:on_step(function() local text = ("%s"):format(t) end)
