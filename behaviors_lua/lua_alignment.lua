-- The built-in `alignment`, written in Lua: each part moves and turns as its neighbours do.
return behavior {
  doc = "Brings each part to the mean velocity of near parts of other bodies. (The built-in alignment, written in Lua.)",
  group = true,
  params = {
    { "min_dist", 0, min = 0, unit = "m", doc = "Nearer parts are left out." },
    { "max_dist", 10, min = 0, unit = "m", doc = "Farther parts are left out." },
    { "linear_amount", 1, unit = "N·s/m", doc = "Force for each m/s of difference." },
    { "angular_amount", 1, unit = "N·m·s/rad", doc = "Torque for each rad/s of difference." },
    { "amount", 1, doc = "Multiplies both." },
  },
  step = function(self)
    local min, max = self.min_dist, self.max_dist
    if max <= min then return end
    for _, part in ipairs(self.parts) do
      local sum, linear, angular, n = vec3(), vec3(), vec3(), 0
      for other, offset, distance in self:neighbors(part, max) do
        if distance >= min then
          n = n + 1
          sum = sum + offset
          linear = linear + other.linear_velocity
          angular = angular + other.angular_velocity
        end
      end
      if n > 0 then
        local s = math.clamp(1 - ((sum / n):length() - min) / (max - min), 0, 1) * self.amount
        part:apply_force((linear / n - part.linear_velocity) * (self.linear_amount * s))
        part:apply_torque((angular / n - part.angular_velocity) * (self.angular_amount * s))
      end
    end
  end,
}
