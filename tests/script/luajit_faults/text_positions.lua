-- string.sub and string.byte with positions outside of the text.
local out = ...
local text, parts = "hello", {}
local positions = { -2147483648, -7, -1, 0, 1, 3, 5, 6, 2147483647, -2147483647 }
for i = 1, 400 do
  local a, b = positions[i % 10 + 1], positions[math.floor(i / 10) % 10 + 1]
  parts[#parts + 1] = text:sub(a, b) .. (text:byte(a) or "-")
end
out(table.concat(parts, " "))
