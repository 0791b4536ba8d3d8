-- Lua's own functions work as usual.
local words = {}
for word in string.gmatch("left right left", "%a+") do table.insert(words, word) end
table.sort(words)
print(table.concat(words, " "), #words) --> left left right 3
print(string.format("%.2f", math.sin(math.pi / 6)), math.max(3, 9)) --> 0.50 9
print(pcall(error, "wrong")) --> false wrong
