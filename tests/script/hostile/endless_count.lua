-- Watches its memory for ever.
-- expect: 4: stopped after
sim:on_step(function()
  repeat until collectgarbage("count") < 0
end)
