-- A coroutine that is resumed in an infinite loop.
-- expect: 5-7: stopped after
sim:on_step(function()
  local co = coroutine.wrap(function()
    while true do coroutine.yield() end
  end)
  while true do co() end
end)
