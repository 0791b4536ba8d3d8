-- Flocking: the three rules of a flock in one, after Reynolds' "Flocks, Herds, and Schools" (SIGGRAPH 1987).
--
--   sim:add_group_behavior("flock", "swarm", { bodies = "bird*", radius = 1.5, speed = 1 })
return behavior {
  doc = "The three rules of a flock: go where the others are, move as they do, keep a distance.",
  group = true,
  params = {
    { "radius", 1.5, min = 0.01, max = 100, unit = "m", doc = "How far each one sees." },
    { "distance", 0.5, min = 0, max = 100, unit = "m", doc = "Others nearer than this are avoided." },
    { "cohesion", 1, min = 0, max = 100, doc = "Acceleration in m/s² for each metre to the middle of the others." },
    { "alignment", 2, min = 0, max = 100, unit = "1/s", doc = "Acceleration for each m/s of difference to the others." },
    { "separation", 4, min = 0, max = 100, unit = "m/s²", doc = "Acceleration away from one that is at hand." },
    { "speed", 1, min = 0, max = 100, unit = "m/s", doc = "The speed that each one likes." },
    { "haste", 1, min = 0, max = 100, unit = "1/s", doc = "How strongly it keeps to its speed." },
  },
  step = function(self)
    local close = self.distance
    for _, part in ipairs(self.parts) do
      local _, middle, motion = self:neighbor_means(part, 0, self.radius)
      local crowd = self:neighbor_means(part, 0, close)
      local v = part.linear_velocity
      local push = v:normalized() * (self.haste * (self.speed - v:length()))
      push = push + middle * self.cohesion + motion * self.alignment
        - self:neighbor_push(part, 0, close) * (crowd * self.separation)
      part:apply_force(push * part.mass)
    end
  end,
}
