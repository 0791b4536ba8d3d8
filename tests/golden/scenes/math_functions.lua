-- Each function of Lua's math library with many arguments: the digits of the results are folded into a parameter.
--@ ticks 60
params { { "digest", 0 } }
-- bits of a number, folded into the parameter `digest`, which is part of the hash
local function fold(x)
  local text, sum = string.format("%.17g", x), params.digest
  for i = 1, #text do sum = (sum * 31 + text:byte(i)) % 2 ^ 45 end
  params.digest = sum
end
local names = { "sin", "cos", "tan", "asin", "acos", "atan", "exp", "log", "log10", "sinh", "cosh", "tanh", "sqrt" }
sim:on_step(function()
  for i = 1, 20 do
    local x = (sim.tick * 20 + i) * 0.0137 * (i % 2 == 0 and -1 or 1)
    for _, name in ipairs(names) do
      local y = x
      if name == "asin" or name == "acos" then y = math.clamp(x / 17, -1, 1) end
      if name == "log" or name == "log10" or name == "sqrt" then y = math.abs(x) end
      fold(math[name](y))
    end
    fold(math.atan2(x, 1.3 - x))
    fold(math.fmod(x * 1000, 0.7))
    fold(math.pow(math.abs(x), 1.7))
    fold(math.abs(x) ^ -0.37)
    fold((1 + x * x) ^ (x * 0.5))
    fold(x ^ 2 + x ^ 3)
    fold(select(1, math.frexp(x)) + math.ldexp(x, i - 10))
    fold(math.deg(x) + math.rad(x))
    fold(math.map(math.lerp(x, 1, 0.3), -1, 1, 0, 0.1))
  end
end)
