-- Texts with many jumps, which are slow to compile: one with too many jumps, and one with the maximum number.
-- expect: 4-12: stopped
local function text_of(jumps)
  local lines = { "local a while true do" }
  for i = 1, jumps do lines[#lines + 1] = "if a then break end" end
  lines[#lines + 1] = "end"
  return table.concat(lines, "\n")
end
sim:on_step(function()
  local large, small = text_of(8000), text_of(1990)
  assert(load(large) == nil)
  while true do load(small) end
end)
