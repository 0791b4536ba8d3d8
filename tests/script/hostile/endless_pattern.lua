-- A pattern with exponential matching time.
-- limits: call_ms=60000
-- expect: 4: this pattern takes too many steps
sim:on_step(function()
  return (("a"):rep(5000)):find(("a*"):rep(50) .. "b")
end)
