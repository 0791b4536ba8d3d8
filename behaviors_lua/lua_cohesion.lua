-- The built-in `cohesion`, written in Lua: pulls each part towards the center of its neighbors in other bodies.
return behavior {
  doc = "Pulls each part towards the center of its neighbors in other bodies. (The built-in cohesion, written in Lua.)",
  group = true,
  params = {
    { "min_dist", 0, min = 0, max = 1e6, unit = "m", doc = "Minimal distance of neighbors." },
    { "max_dist", 10, min = 0, max = 1e6, unit = "m", doc = "Maximal distance of neighbors." },
    { "amount", 1, min = -1e9, max = 1e9, unit = "N", doc = "Force; negative: away from the neighbors." },
  },
  step = function(self)
    local near, far, amount = self.min_dist, self.max_dist, self.amount
    if far <= near then return end
    for _, part in ipairs(self.parts) do
      local n, offset = self:neighbor_means(part, near, far)
      if n > 0 then
        local s = near > 0 and math.clamp((offset:length() - near) / (far - near), 0, 1) or 1
        part:apply_force(offset:normalized() * (amount * s))
      end
    end
  end,
}
