-- Compiles for ever.
-- expect: 4-5: stopped
sim:on_step(function()
  local n = 0
  while true do n = n + load("local x = " .. n .. " return 1")() end
end)
