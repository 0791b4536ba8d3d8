-- A text that doubles in size.
-- limits: call_ms=10000
-- expect: 6: stopped: scripts can use
sim:on_step(function()
  local text = "x"
  while true do text = text .. text end
end)
