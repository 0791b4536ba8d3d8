-- Creates and removes a body in an infinite loop.
-- expect: 4-5: stopped
sim:on_step(function()
  while true do
    sim:body("victim"):copy("new"):remove()
  end
end)
