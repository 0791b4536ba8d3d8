-- A leak of 200 kB in each tick: it meets the limit in some tick, and others go on.
-- limits: call_ms=10000 memory=8
-- expect: 5: stopped: scripts may hold
kept = {}
sim:on_step(function() kept[#kept + 1] = ("x"):rep(200000) .. #kept end)
