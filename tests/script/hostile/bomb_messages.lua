-- Many messages with text.
-- expect: 6: one call may send up to 10000 messages and 1 MB of text
-- sent: 0
local text = ("x"):rep(1000)
sim:on_step(function()
  while true do osc:send("/a", text) end
end)
