-- Plain Lua: tables, strings, patterns, sorting, closures, coroutines; the results are folded into a parameter.
--@ ticks 60
params { { "digest", 0 } }
-- bits of a number, folded into the parameter `digest`, which is part of the hash
local function fold(x)
  local text, sum = string.format("%.17g", x), params.digest
  for i = 1, #text do sum = (sum * 31 + text:byte(i)) % 2 ^ 45 end
  params.digest = sum
end
local walk = coroutine.wrap(function()
  local n = 0
  while true do n = (n * 1.25 + rng:uniform(0, 1)) % 3; coroutine.yield(n) end
end)
local names = { "c", "a", "b", x = 1, y = 2 }
sim:on_step(function()
  local list = {}
  for i = 1, 30 do list[i] = (i * 7919 + sim.tick * 31) % 101 + 0.1 * i end
  table.sort(list, function(a, b) return a > b end)
  for i, x in ipairs(list) do fold(x * i) end
  local text = ("%d/%s/%5.2f"):format(sim.tick, table.concat(list, ","), list[3])
  for word in text:gmatch("%d+") do fold(tonumber(word)) end
  fold(#text:gsub("(%d)%.", "<%1>"):upper())
  for key in pairs(names) do if type(key) == "string" then fold(key:byte()) end end
  fold(walk())
  fold(bit.bxor(bit.lshift(sim.tick, 7), 0x5bd1e995) + bit.ror(sim.tick, 3))
end)
