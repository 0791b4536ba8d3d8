-- A handler that loops tries again with the next message.
-- expect: 5: stopped after
-- expect: 5: stopped after
-- messages: 2
osc:on("/hit", function() while true do end end)
