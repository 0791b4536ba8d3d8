-- Sums beyond 2^51 below a bit operation are computed with 32 bits instead of being rounded.
local out = ...
local sum = 0
for i = 1, 200 do
  sum = bit.bxor(sum, (i + 2 ^ 53) % 65536, bit.tobit(i - 2 ^ 52))
  out(sum)
end
