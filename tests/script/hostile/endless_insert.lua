-- A table that is filled from its front.
-- expect: 5: stopped
sim:on_step(function()
  local t = {}
  while true do table.insert(t, 1, 1) end
end)
