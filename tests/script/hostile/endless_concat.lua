-- Concatenates texts in an infinite loop.
-- expect: 4-6: stopped
sim:on_step(function()
  local t = {}
  for i = 1, 10000 do t[i] = "some text" end
  while true do local text = table.concat(t, ",") end
end)
