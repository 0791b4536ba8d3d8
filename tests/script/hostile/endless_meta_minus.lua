-- A metamethod that never returns: __unm.
-- expect: 3: stopped after
local t = setmetatable({}, { __unm = function() while true do end end })
sim:on_step(function() local x = -t end)
