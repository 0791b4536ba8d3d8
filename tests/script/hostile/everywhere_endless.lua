-- An infinite loop in each kind of callback.
-- expect: 8: stopped after
-- expect: 9: stopped after
-- expect: 10: stopped after
-- expect: 11: stopped after
-- expect: 13: stopped after
-- expect: 12: stopped after
sim:on_start(function() while true do end end)
sim:on_step(function() while true do end end)
sim:every(0.1, function() while true do end end)
sim:after(0.2, function() while true do end end)
sim:at(0.3, function() while true do end end)
sim:on_contact(function() while true do end end)
