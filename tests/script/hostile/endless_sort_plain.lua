-- Sorts a large table without a comparison function in an infinite loop.
-- expect: 4-7: stopped
sim:on_step(function()
  local t = {}
  for i = 1, 500000 do t[i] = (i * 7919) % 1000003 end
  table.sort(t)
  while true do table.sort(t) end
end)
