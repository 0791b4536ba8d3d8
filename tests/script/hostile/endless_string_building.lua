-- A text that grows by one letter.
-- expect: 4-5: stopped
sim:on_step(function()
  local text = ""
  while true do text = text .. "x" end
end)
