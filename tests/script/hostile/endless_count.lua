-- Queries the memory use in an infinite loop.
-- expect: 4: stopped after
sim:on_step(function()
  repeat until collectgarbage("count") < 0
end)
