-- gsub in an infinite loop.
-- expect: 4-5: stopped
sim:on_step(function()
  local text = ("abc "):rep(1000)
  while true do text = text:gsub("%w+", "%0") end
end)
