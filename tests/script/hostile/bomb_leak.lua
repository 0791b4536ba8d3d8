-- A leak of 200 kB per tick: reaches the limit in some tick, and other callbacks continue.
-- limits: call_ms=10000 memory=8
-- expect: 5: stopped: scripts can use
stored = {}
sim:on_step(function() stored[#stored + 1] = ("x"):rep(200000) .. #stored end)
