-- Flocking: the three rules of a flock in one, after Reynolds' "Flocks, Herds, and Schools" (SIGGRAPH 1987).
--
--   sim:add_group_behavior("flock", "swarm", { bodies = "bird*", radius = 1.5, speed = 1 })
return behavior {
  doc = "The three rules of a flock: go where the others are, move as they do, keep a distance.",
  group = true,
  params = {
    { "radius", 1.5, min = 0.01, max = 100, unit = "m", doc = "How far each one sees." },
    { "distance", 0.5, min = 0, max = 100, unit = "m", doc = "Others nearer than this are avoided." },
    { "cohesion", 1, min = 0, max = 100, unit = "1/s²", doc = "Acceleration for each metre to the middle of the others." },
    { "alignment", 2, min = 0, max = 100, unit = "1/s", doc = "Acceleration for each m/s of difference to the others." },
    { "separation", 4, min = 0, max = 100, unit = "m/s²", doc = "Acceleration away from one that is at hand." },
    { "speed", 1, min = 0, max = 100, unit = "m/s", doc = "The speed that each one likes." },
    { "haste", 1, min = 0, max = 100, unit = "1/s", doc = "How strongly it keeps to its speed." },
  },
  step = function(self)
    for _, part in ipairs(self.parts) do
      local v = part.linear_velocity
      local middle, moving, away, n = vec3(), vec3(), vec3(), 0
      for other, offset, distance in self:neighbors(part, self.radius) do
        n = n + 1
        middle = middle + offset
        moving = moving + other.linear_velocity
        if distance < self.distance then away = away - offset:normalized() * (1 - distance / self.distance) end
      end
      local push = v:normalized() * (self.haste * (self.speed - v:length()))
      if n > 0 then
        push = push + middle * (self.cohesion / n) + (moving / n - v) * self.alignment + away * self.separation
      end
      part:apply_force(push * part.mass)
    end
  end,
}
