-- Recursive gsub.
-- limits: call_ms=10000
-- expect: 4-5: stack overflow|error in error handling
local function f() return (("x"):gsub("x", f)) end
sim:on_step(function() f() end)
