-- The handler of an error never ends.
-- expect: 4: stopped after
sim:on_step(function()
  xpcall(error, function() while true do end end, "x")
end)
