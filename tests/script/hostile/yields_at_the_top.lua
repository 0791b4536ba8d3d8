-- Yields outside of a coroutine.
-- expect: 3: attempt to yield
sim:on_step(function() coroutine.yield() end)
