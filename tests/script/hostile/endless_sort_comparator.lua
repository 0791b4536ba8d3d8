-- A comparison function that never returns.
-- expect: 4: stopped after
sim:on_step(function()
  table.sort({ 3, 1, 2 }, function() while true do end end)
end)
