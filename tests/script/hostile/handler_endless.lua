-- A handler that loops is stopped, and disabled.
-- expect: 4: stopped after
-- messages: 2
osc:on("/hit", function() while true do end end)
