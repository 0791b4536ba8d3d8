-- A loop with a condition that is never met.
-- expect: 5: stopped after
sim:on_step(function()
  local i = 0
  repeat i = i + 1 until i < 0
end)
