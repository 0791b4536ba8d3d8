-- A megabyte a thousand times, joined.
-- limits: call_ms=10000
-- expect: 4: not enough memory: scripts may hold|stopped: scripts may hold
sim:on_step(function()
  local t, text = {}, ("x"):rep(1e6)
  for i = 1, 1000 do t[i] = text end return table.concat(t)
end)
