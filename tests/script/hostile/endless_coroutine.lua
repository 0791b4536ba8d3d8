-- An infinite loop inside a coroutine.
-- expect: 4: stopped after
sim:on_step(function()
  coroutine.wrap(function() while true do end end)()
end)
