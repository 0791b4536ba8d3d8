-- A coroutine that catches the stop, inside another one.
-- expect: 5-9: stopped after
sim:on_step(function()
  local co = coroutine.create(function()
    while true do
      pcall(coroutine.wrap(function() while true do end end))
    end
  end)
  while true do coroutine.resume(co) end
end)
