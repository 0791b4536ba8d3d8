-- Math results that move bodies: targets from sines, exponentials, powers and logarithms, each tick.
--@ ticks 150
local arms = {}
for i = 1, 3 do arms[i] = sim:load_urdf("urdf/arm6.urdf", { name = "arm" .. i, position = vec3(i, 0, 0) }) end
sim:on_step(function()
  local t = sim.time
  for i, arm in ipairs(arms) do
    for j, motor in ipairs(arm.motors) do
      local x = t * (0.3 + 0.2 * j) + i
      local f = j % 6
      motor.target = f == 0 and 0.4 * math.sin(x) or f == 1 and 0.3 * math.tan(math.cos(x)) or f == 2 and math.exp(-x) - 0.2
        or f == 3 and 0.2 * math.log(1 + x) - 0.3 or f == 4 and 0.1 * x ^ 1.3 - 0.2 or 0.5 * math.atan2(math.sinh(0.1 * x), x)
    end
  end
end)
