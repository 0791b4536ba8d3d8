-- Asks for the state's hash for ever.
-- expect: 4: stopped
sim:on_step(function()
  while true do sim:state_hash() end
end)
