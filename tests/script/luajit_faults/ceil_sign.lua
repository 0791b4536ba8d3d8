-- math.ceil loses the sign of -0 when interpreted.
local out = ...
local values, text = { -0.9, -0.25, 0, 0.5, -1.5 }, ""
for i = 1, 200 do
  local x = math.ceil(values[i % 5 + 1])
  text = text .. (1 / x < 0 and "-" or "+")
end
out(text)
