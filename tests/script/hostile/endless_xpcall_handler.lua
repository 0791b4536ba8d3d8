-- An error handler that never returns.
-- expect: 4: stopped after
sim:on_step(function()
  xpcall(error, function() while true do end end, "x")
end)
