-- A text that grows by replacement of each letter.
-- limits: call_ms=10000 memory=16
-- expect: 5: stopped: scripts can use|not enough memory: scripts can use
sim:on_step(function()
  local text = ("x"):rep(1000) while true do text = text:gsub("x", "xx") end
end)
