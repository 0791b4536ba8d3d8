-- Nested coroutines.
-- expect: 3-4: 100 deep
local function f() return coroutine.wrap(f)() end
sim:on_step(function() f() end)
