-- A metamethod that never returns: __lt.
-- expect: 3: stopped after
local t = setmetatable({}, { __lt = function() while true do end end })
sim:on_step(function() local x = t < t end)
