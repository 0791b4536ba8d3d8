-- Cancels another callback's timer, then raises an error: the timer continues.
-- expect: 5: on purpose
-- printed: 9
local timer = sim:every(1, function() print("beat") end)
sim:on_step(function() timer:cancel() error("on purpose") end)
