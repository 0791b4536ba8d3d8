-- A table that grows.
-- limits: call_ms=10000 memory=16
-- expect: 6: stopped: scripts can use
sim:on_step(function()
  local t = {}
  for i = 1, math.huge do t[i] = i end
end)
