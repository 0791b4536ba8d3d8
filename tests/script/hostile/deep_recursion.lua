-- Infinite recursion.
-- expect: 3-4: stack overflow
local function f() return 1 + f() end
sim:on_step(function() f() end)
