-- A loop over pairs, or over next, ends too early.
local out = ...
local inner = { 1, 2, 3, 4, 5 }
local t = { a = inner, b = inner, c = inner, d = inner, e = inner }
local function nothing()
  for _ = 1, 100 do end
end
local wrong = 0
for _ = 1, 60000 do
  nothing()
  local count = 0
  for _, v in pairs(t) do
    for _ in pairs(v) do end
    count = count + 1
  end
  if count ~= 5 then wrong = wrong + 1 end
end
out(wrong)
