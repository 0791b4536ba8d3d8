-- Formats numbers in an infinite loop.
-- expect: 4: stopped
sim:on_step(function()
  while true do local text = ("%99.99f %s"):format(1 / 3, vec3(1, 2, 3)) end
end)
