-- A message with text of megabytes.
-- limits: call_ms=50
-- expect: 5: late
sim:on_step(function() osc:send("/a", ("x"):rep(4e6))
  error("late") end)
