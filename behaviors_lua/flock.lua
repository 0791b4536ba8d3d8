-- flock: the three rules of a flock in one behavior, after Reynolds' "Flocks, Herds, and Schools" (SIGGRAPH 1987).
--
--   sim:add_group_behavior("flock", "swarm", { bodies = "bird*", radius = 1.5, speed = 1 })
return behavior {
  doc = "The three rules of a flock: cohesion, alignment and separation.",
  group = true,
  params = {
    { "radius", 1.5, min = 0.01, max = 100, unit = "m", doc = "Radius of the neighborhood." },
    { "distance", 0.5, min = 0, max = 100, unit = "m", doc = "Distance below which separation acts." },
    { "cohesion", 1, min = 0, max = 100, doc = "Acceleration in m/s² per meter to the center of the neighbors." },
    { "alignment", 2, min = 0, max = 100, unit = "1/s", doc = "Acceleration per m/s of difference to the neighbors' velocity." },
    { "separation", 4, min = 0, max = 100, unit = "m/s²", doc = "Acceleration away from a neighbor at distance 0." },
    { "speed", 1, min = 0, max = 100, unit = "m/s", doc = "Preferred speed." },
    { "haste", 1, min = 0, max = 100, unit = "1/s", doc = "How fast the preferred speed is approached." },
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
