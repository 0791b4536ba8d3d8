-- Makes a body and removes it, for ever.
-- expect: 4-5: stopped
sim:on_step(function()
  while true do
    sim:body("victim"):copy("new"):remove()
  end
end)
