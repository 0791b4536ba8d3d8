-- A numeric loop to infinity.
-- expect: 5: stopped after
sim:on_step(function()
  local sum = 0
  for i = 1, math.huge do sum = sum + i end
end)
