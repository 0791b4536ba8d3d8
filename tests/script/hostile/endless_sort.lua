-- Sorts a large table with an inconsistent comparison in an infinite loop.
-- expect: 4-6: stopped
sim:on_step(function()
  local t = {}
  for i = 1, 1000 do t[i] = i % 7 end
  while true do table.sort(t, function(a, b) return true end) end
end)
