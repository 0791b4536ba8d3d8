-- Avoids neighbors, and follows their mean motion.
return behavior {
  doc = "Avoids neighbors, and follows the mean motion of the group.",
  group = true,
  params = {
    { "radius", 0.5, min = 0, max = 10, unit = "m", doc = "Distance from which on neighbors don't matter." },
    { "push", 2, min = 0, max = 100, unit = "N", doc = "Force away from a neighbor that touches." },
  },
  step = function(self)
    for _, part in ipairs(self.parts) do
      -- one neighbor at a time
      for other, offset, distance in self:neighbors(part, self.radius) do
        part:apply_force(offset:normalized() * (-self.push * (1 - distance / self.radius)))
      end
      -- faster: sums over all neighbors, computed for the whole group at once
      local count, center, velocity = self:neighbor_means(part, 0, self.radius)
      if count > 0 then part:apply_force(velocity * 0.1 + center * 0.05) end
      part:apply_force(self:neighbor_push(part, 0, self.radius) * -0.1)
    end
  end,
}
