-- An error with megabytes of text.
-- limits: call_ms=50
-- expect: 4: xxx
sim:on_step(function() error(("x"):rep(4e6)) end)
