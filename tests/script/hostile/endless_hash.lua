-- Queries the state hash in an infinite loop.
-- expect: 4: stopped
sim:on_step(function()
  while true do sim:state_hash() end
end)
