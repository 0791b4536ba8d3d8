-- Removes all bodies, then loops.
-- expect: 4-6: stopped after
sim:on_step(function()
  sim:body("healthy"):remove()
  sim:body("victim"):remove()
  while true do end
end)
