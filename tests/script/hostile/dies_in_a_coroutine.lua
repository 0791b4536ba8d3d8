-- An error inside a coroutine is the resumer's to see.
-- expect: 4: inside
local co = coroutine.wrap(function()
  coroutine.yield() error("inside") end)
sim:on_step(function() co() end)
