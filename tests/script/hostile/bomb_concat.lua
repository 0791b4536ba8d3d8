-- Concatenates a megabyte a thousand times.
-- limits: call_ms=10000
-- expect: 4: not enough memory: scripts can use|stopped: scripts can use
sim:on_step(function()
  local t, text = {}, ("x"):rep(1e6)
  for i = 1, 1000 do t[i] = text end return table.concat(t)
end)
