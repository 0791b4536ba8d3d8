-- Many small tables that are all referenced.
-- limits: call_ms=10000 memory=8
-- expect: 5: stopped: scripts can use
stored = {}
sim:on_step(function() while true do stored[#stored + 1] = { 1, 2, 3 } end end)
