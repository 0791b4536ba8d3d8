-- Catches the stop in its last instruction.
-- expect: 4: stopped after
sim:on_step(function()
  return pcall(function() while true do end end)
end)
