-- A text that doubles.
-- limits: call_ms=10000
-- expect: 6: stopped: scripts may hold
sim:on_step(function()
  local text = "x"
  while true do text = text .. text end
end)
