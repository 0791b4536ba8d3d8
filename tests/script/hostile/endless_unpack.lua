-- Unpacks many values in an infinite loop.
-- expect: 4-6: stopped
sim:on_step(function()
  local t = {}
  for i = 1, 5000 do t[i] = i end
  while true do local n = select("#", unpack(t)) end
end)
