-- Inserts at the front of a table.
-- expect: 5: stopped
sim:on_step(function()
  local t = {}
  while true do table.insert(t, 1, 1) end
end)
