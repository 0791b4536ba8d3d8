-- Requests a reset, then raises an error: no reset occurs.
-- expect: 3: on purpose
sim:on_step(function() sim:reset() error("on purpose") end)
