-- The built-in `cohesion`, written in Lua: draws each part towards the middle of its neighbours in other bodies.
return behavior {
  doc = "Draws each part towards the middle of its neighbours in other bodies. (The built-in cohesion, written in Lua.)",
  group = true,
  params = {
    { "min_dist", 0, min = 0, max = 1e6, unit = "m", doc = "Neighbours are further away than this" },
    { "max_dist", 10, min = 0, max = 1e6, unit = "m", doc = "and nearer than this." },
    { "amount", 1, min = -1e9, max = 1e9, unit = "N", doc = "Force; below 0: away from the neighbours." },
  },
  step = function(self)
    local near, far, amount = self.min_dist, self.max_dist, self.amount
    if far <= near then return end
    for _, part in ipairs(self.parts) do
      local n, way = self:neighbor_means(part, near, far)
      if n > 0 then
        local s = near > 0 and math.clamp((way:length() - near) / (far - near), 0, 1) or 1
        part:apply_force(way:normalized() * (amount * s))
      end
    end
  end,
}
