-- gmatch in an infinite loop.
-- expect: 4-7: stopped after
sim:on_step(function()
  local text, n = ("abc "):rep(1000), 0
  while true do
    for word in text:gmatch("%w+") do n = n + #word end
  end
end)
