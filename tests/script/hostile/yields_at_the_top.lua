-- Yields where there is nobody to yield to.
-- expect: 3: attempt to yield
sim:on_step(function() coroutine.yield() end)
