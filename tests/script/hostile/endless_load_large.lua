-- A text whose jumps take the compiler long.
-- expect: 8-10: stopped
local lines = { "local a while true do" }
for i = 1, 8000 do lines[#lines + 1] = "if a then break end" end
lines[#lines + 1] = "end"
local text = table.concat(lines, "\n")
sim:on_step(function()
  while true do
    load(text)
  end
end)
