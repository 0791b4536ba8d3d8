-- Recursive sort.
-- limits: call_ms=10000
-- expect: 4-5: stack overflow|error in error handling
local function f() table.sort({ 1, 2 }, f) return true end
sim:on_step(function() f() end)
