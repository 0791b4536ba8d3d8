-- A coroutine that starts in one tick and loops in a later one.
-- expect: 5-6: stopped after
local co = coroutine.wrap(function()
  for i = 1, 5 do coroutine.yield(i) end
  while true do
    local x = 1
  end
end)
sim:on_step(function() co() end)
