-- A text that grows by each letter's replacement.
-- limits: call_ms=10000 memory=16
-- expect: 5: stopped: scripts may hold|not enough memory: scripts may hold
sim:on_step(function()
  local text = ("x"):rep(1000) while true do text = text:gsub("x", "xx") end
end)
