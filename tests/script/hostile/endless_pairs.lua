-- pairs over a growing table in an infinite loop.
-- expect: 4-5: stopped
sim:on_step(function()
  local t = { 1 }
  while true do for k in pairs(t) do t[#t + 1] = k end end
end)
