-- Calls a missing function.
-- expect: 3: has no property
sim:on_step(function() sim:body("healthy").root.jump() end)
