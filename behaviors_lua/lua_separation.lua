-- The built-in `separation`, written in Lua: near parts of other bodies are avoided.
return behavior {
  doc = "Pushes each part away from near parts of other bodies. (The built-in separation, written in Lua.)",
  group = true,
  params = {
    { "min_dist", 0, min = 0, unit = "m", doc = "Nearer parts are left out." },
    { "max_dist", 1, min = 0, unit = "m", doc = "Farther parts are left out." },
    { "amount", 1, unit = "N", doc = "Force when the others are at hand; negative: towards them." },
  },
  step = function(self)
    local min, max, amount = self.min_dist, self.max_dist, self.amount
    if max <= min then return end
    for _, part in ipairs(self.parts) do
      local sum, n = vec3(), 0
      for _, offset, distance in self:neighbors(part, max) do
        if distance >= min then
          n = n + 1
          sum = sum + offset:normalized() * (1 - distance / max)
        end
      end
      if n > 0 then part:apply_force(sum * (-amount / n)) end
    end
  end,
}
