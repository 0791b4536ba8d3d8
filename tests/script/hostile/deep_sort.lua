-- sort inside sort.
-- limits: call_ms=200
-- expect: 4-5: stack overflow
local function f() table.sort({ 1, 2 }, f) return true end
sim:on_step(function() f() end)
