-- An error inside a coroutine is passed to the caller of resume.
-- expect: 4: inside
local co = coroutine.wrap(function()
  coroutine.yield() error("inside") end)
sim:on_step(function() co() end)
