-- An error in each kind of callback.
-- expect: 8: start
-- expect: 9: step
-- expect: 10: every
-- expect: 11: after
-- expect: 13: contact
-- expect: 12: at
sim:on_start(function() error("start") end)
sim:on_step(function() error("step") end)
sim:every(0.1, function() error("every") end)
sim:after(0.2, function() error("after") end)
sim:at(0.3, function() error("at") end)
sim:on_contact(function() error("contact") end)
