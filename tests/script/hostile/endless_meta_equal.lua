-- A metamethod that never returns: __eq.
-- expect: 3: stopped after
local t = setmetatable({}, { __eq = function() while true do end end })
sim:on_step(function() local x = t == setmetatable({}, getmetatable(t)) end)
