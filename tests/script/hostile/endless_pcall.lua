-- Catches the stop in an infinite loop.
-- expect: 4-5: stopped after
sim:on_step(function()
  while true do
    pcall(function() while true do end end)
  end
end)
