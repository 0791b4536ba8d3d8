-- The built-in `cohesion`, written in Lua: each part goes where its neighbours are.
return behavior {
  doc = "Pulls each part to the middle of near parts of other bodies. (The built-in cohesion, written in Lua.)",
  group = true,
  params = {
    { "min_dist", 0, min = 0, unit = "m", doc = "Nearer parts are left out." },
    { "max_dist", 10, min = 0, unit = "m", doc = "Farther parts are left out." },
    { "amount", 1, unit = "N", doc = "Force; negative: evades." },
  },
  step = function(self)
    local min, max, amount = self.min_dist, self.max_dist, self.amount
    if max <= min then return end
    for _, part in ipairs(self.parts) do
      local sum, n = vec3(), 0
      for _, offset, distance in self:neighbors(part, max) do
        if distance >= min then
          n = n + 1
          sum = sum + offset
        end
      end
      if n > 0 then
        local mean = sum / n
        local s = min > 0 and math.clamp((mean:length() - min) / (max - min), 0, 1) or 1
        part:apply_force(mean:normalized() * (amount * s))
      end
    end
  end,
}
