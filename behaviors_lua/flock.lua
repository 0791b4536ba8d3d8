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
      -- summed as numbers: a vec3 that lives on from turn to turn would be made anew at each
      local n, x, y, z = 0, 0, 0, 0 -- where the others are
      local vx, vy, vz = 0, 0, 0    -- how they move
      local ax, ay, az = 0, 0, 0    -- away from those that are too near
      for other, offset, distance in self:neighbors(part, self.radius) do
        local v = other.linear_velocity
        n, x, y, z = n + 1, x + offset.x, y + offset.y, z + offset.z
        vx, vy, vz = vx + v.x, vy + v.y, vz + v.z
        if distance < close and distance > 0 then
          local share = 1 / distance - 1 / close
          ax, ay, az = ax - offset.x * share, ay - offset.y * share, az - offset.z * share
        end
      end
      local v = part.linear_velocity
      local push = v:normalized() * (self.haste * (self.speed - v:length()))
      if n > 0 then
        push = push + vec3(x, y, z) * (self.cohesion / n) + (vec3(vx, vy, vz) / n - v) * self.alignment
          + vec3(ax, ay, az) * self.separation
      end
      part:apply_force(push * part.mass)
    end
  end,
}
