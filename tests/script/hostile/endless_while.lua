-- A plain loop, compiled in no time.
-- expect: 4: stopped after
sim:on_step(function()
  while true do end
end)
