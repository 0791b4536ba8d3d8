-- Compiles in an infinite loop.
-- expect: 4-5: stopped
sim:on_step(function()
  local n = 0
  while load("local x = " .. n .. " return 1") do n = n + 1 end
end)
