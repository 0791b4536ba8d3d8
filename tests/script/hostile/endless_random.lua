-- Waits for a number that never comes.
-- expect: 4: stopped after
sim:on_step(function()
  repeat until math.random() > 2
end)
