-- Vectors, all kept.
-- limits: call_ms=10000 memory=8
-- expect: 5: stopped: scripts may hold
kept = {}
sim:on_step(function() for i = 1, math.huge do kept[i] = vec3(i, i, i) end end)
