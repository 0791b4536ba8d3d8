-- An empty loop, which is compiled at once.
-- expect: 4: stopped after
sim:on_step(function()
  while true do end
end)
