-- A handler that indexes a missing argument.
-- expect: 4: attempt to index
-- messages: 1
osc:on("/hit", function(value) return value.x.y end)
