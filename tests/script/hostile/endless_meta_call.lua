-- A metamethod that never returns: __call.
-- expect: 3: stopped after
local t = setmetatable({}, { __call = function() while true do end end })
sim:on_step(function() t() end)
