-- A goto to itself.
-- expect: 4-5: stopped after
sim:on_step(function()
  ::again::
  goto again
end)
