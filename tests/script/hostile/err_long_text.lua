-- An error with megabytes of text.
-- expect: 3: xxx
sim:on_step(function() error(("x"):rep(4e6)) end)
