-- Errors with name suggestions, each caught.
-- expect: 4: stopped
sim:on_step(function()
  while true do pcall(function() return sim:body("helthy").posision end) end
end)
