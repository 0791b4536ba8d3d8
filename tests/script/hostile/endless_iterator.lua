-- An iterator that never ends.
-- expect: 4: stopped after
sim:on_step(function()
  for x in function() return 1 end do local y = x end
end)
