-- A metamethod that never returns: __concat.
-- expect: 3: stopped after
local t = setmetatable({}, { __concat = function() while true do end end })
sim:on_step(function() local x = t .. "a" end)
