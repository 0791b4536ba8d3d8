-- A variable that alternates between two constant tables has the values of the wrong one.
local out = ...
local slot, wrong = { true }, 0
for i = 1, 300 do
  local value = slot[1]
  if i > 1 and value ~= (i % 2 == 1) then wrong = wrong + 1 end
  slot = i % 2 ~= 0 and { false } or { true }
end
out(wrong)
local text, list = {}, { "a" }
for i = 1, 300 do
  text[#text + 1] = tostring(list[1])
  list = i % 2 ~= 0 and { 7 } or { "b" }
end
out(table.concat(text))
