-- Infinite recursion of pcall.
-- limits: call_ms=200
-- expect: 3-6: stopped after
local function f() pcall(f) end
sim:on_step(function() while true do f() end end)
