-- A new coroutine in each iteration.
-- expect: 4-5: stopped
sim:on_step(function()
  while true do
    coroutine.resume(coroutine.create(function() coroutine.yield(1) end))
  end
end)
