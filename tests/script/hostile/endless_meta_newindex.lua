-- A metamethod that never returns: __newindex.
-- expect: 3: stopped after
local t = setmetatable({}, { __newindex = function() while true do end end })
sim:on_step(function() t.a = 1 end)
