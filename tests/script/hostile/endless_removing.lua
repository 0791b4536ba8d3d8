-- Removes all bodies, then waits for ever.
-- expect: 4-6: stopped after
sim:on_step(function()
  sim:body("healthy"):remove()
  sim:body("victim"):remove()
  while true do end
end)
