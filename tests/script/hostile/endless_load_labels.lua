-- Labels and jumps between which the compiler looks for each other.
-- expect: 8-10: stopped
local lines = {}
for i = 1, 20000 do lines[#lines + 1] = "goto a" .. i end
for i = 1, 20000 do lines[#lines + 1] = "::a" .. i .. "::" end
local text = table.concat(lines, "\n")
sim:on_step(function()
  while true do
    load(text)
  end
end)
