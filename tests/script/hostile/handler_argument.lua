-- Takes apart what it was not given.
-- expect: 4: attempt to index
-- messages: 1
osc:on("/hit", function(value) return value.x.y end)
