-- A metamethod that never returns: __index.
-- expect: 3: stopped after
local t = setmetatable({}, { __index = function() while true do end end })
sim:on_step(function() local x = t.a end)
