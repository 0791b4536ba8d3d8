-- A loop that counts, whose end is never reached.
-- expect: 5: stopped after
sim:on_step(function()
  local i = 0
  repeat i = i + 1 until i < 0
end)
