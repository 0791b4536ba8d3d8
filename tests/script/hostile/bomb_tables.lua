-- Many small tables, all kept.
-- limits: call_ms=10000 memory=8
-- expect: 5: stopped: scripts may hold
kept = {}
sim:on_step(function() while true do kept[#kept + 1] = { 1, 2, 3 } end end)
