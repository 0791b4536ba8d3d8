-- A message with megabytes of text.
-- expect: 5: one call may send up to 10000 messages and 1 MB of text
-- sent: 0
sim:on_step(function() osc:send("/a", ("x"):rep(500000))
  osc:send("/a", ("x"):rep(600000)) end)
