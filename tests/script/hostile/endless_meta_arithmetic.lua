-- A metamethod that never returns: __add.
-- expect: 3: stopped after
local t = setmetatable({}, { __add = function() while true do end end })
sim:on_step(function() local x = t + 1 end)
