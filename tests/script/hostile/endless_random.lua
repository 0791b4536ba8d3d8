-- Waits for a random number that never occurs.
-- expect: 4: stopped after
sim:on_step(function()
  repeat until math.random() > 2
end)
