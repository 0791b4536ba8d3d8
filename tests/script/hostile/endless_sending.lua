-- Sends messages in an infinite loop: none is sent.
-- expect: 5: stopped|messages
-- sent: 0
sim:on_step(function()
  while true do osc:send("/flood", 1, "two", vec3(3, 4, 5)) end
end)
