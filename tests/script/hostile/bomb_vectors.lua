-- Vectors that are all referenced.
-- limits: call_ms=10000 memory=8
-- expect: 5: stopped: scripts can use
stored = {}
sim:on_step(function() for i = 1, math.huge do stored[i] = vec3(i, i, i) end end)
