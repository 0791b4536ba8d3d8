-- The same inside pcall.
-- limits: call_ms=10000
-- expect: 5-6: stopped: scripts can use
sim:on_step(function() while true do pcall(function()
  local text = "x" while true do text = text .. text end
end) end end)
