-- The last thing that it does is to catch what stops it.
-- expect: 4: stopped after
sim:on_step(function()
  return pcall(function() while true do end end)
end)
