-- orbit: moves parts on a circle around a point with a given radius and speed.
--
--   moon:add_behavior("orbit", "round", { center = vec3(0, 0, 1), radius = 0.8, speed = 1.5 })
return behavior {
  doc = "Moves parts on a circle around a point.",
  params = {
    { "center", vec3(0, 0, 1), unit = "m", doc = "Center of the circle, world." },
    { "axis", vec3(0, 0, 1), doc = "Normal of the circle; seen from its tip, the motion is counterclockwise." },
    { "radius", 1, min = 0.01, max = 100, unit = "m", doc = "Radius of the circle." },
    { "speed", 1, min = -20, max = 20, unit = "m/s", doc = "Speed along the circle; negative: reversed." },
    { "grip", 4, min = 0, max = 50, unit = "1/s", doc = "How fast a part approaches the circle." },
    { "lift", true, doc = "Whether the parts' weight is compensated." },
  },
  step = function(self)
    local axis, grip = self.axis:normalized(), self.grip
    if axis:length() == 0 then return end
    local lift = self.lift and -sim.gravity or vec3()
    -- at the center, all directions outwards are equivalent
    local any_direction = (math.abs(axis.x) < 0.9 and vec3(1, 0, 0) or vec3(0, 1, 0)):cross(axis):normalized()
    for _, part in ipairs(self.parts) do
      local from = part.center - self.center
      local height = from:dot(axis)
      local flat = from - axis * height
      local r = flat:length()
      local out = r > 1e-6 and flat / r or any_direction
      local along = axis:cross(out)
      local wanted = along * self.speed + out * (grip * (self.radius - r)) - axis * (grip * height)
      -- centripetal acceleration, and correction of the velocity
      local v = along:dot(part.linear_velocity)
      local inwards = out * (-v * v / math.max(r, 0.5 * self.radius))
      part:apply_force(((wanted - part.linear_velocity) * (2 * grip) + inwards + lift) * part.mass)
    end
  end,
}
