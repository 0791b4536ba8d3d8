-- Orbiting: parts circle about a point, at a radius and a speed.
--
--   moon:add_behavior("orbit", "round", { center = vec3(0, 0, 1), radius = 0.8, speed = 1.5 })
return behavior {
  doc = "Leads parts onto a circle about a point and along it.",
  params = {
    { "center", vec3(0, 0, 1), unit = "m", doc = "Middle of the circle, in the world." },
    { "axis", vec3(0, 0, 1), doc = "The circle is square to this; seen from its tip it goes anticlockwise." },
    { "radius", 1, min = 0.01, max = 100, unit = "m", doc = "Of the circle." },
    { "speed", 1, min = -20, max = 20, unit = "m/s", doc = "Along the circle; negative: the other way round." },
    { "grip", 4, min = 0, max = 50, unit = "1/s", doc = "How quickly a part is brought onto the circle." },
    { "lift", true, doc = "Whether the parts' weight is made up for." },
  },
  step = function(self)
    local axis, grip = self.axis:normalized(), self.grip
    if axis:length() == 0 then return end
    local lift = self.lift and -sim.gravity or vec3()
    -- from the very middle any way out is as good
    local somewhere = (math.abs(axis.x) < 0.9 and vec3(1, 0, 0) or vec3(0, 1, 0)):cross(axis):normalized()
    for _, part in ipairs(self.parts) do
      local from = part.center - self.center
      local height = from:dot(axis)
      local flat = from - axis * height
      local r = flat:length()
      local out = r > 1e-6 and flat / r or somewhere
      local along = axis:cross(out)
      local wanted = along * self.speed + out * (grip * (self.radius - r)) - axis * (grip * height)
      -- what keeps it on a circle of this radius, and what is missing to the wanted velocity
      local v = along:dot(part.linear_velocity)
      local inwards = out * (-v * v / math.max(r, 0.5 * self.radius))
      part:apply_force(((wanted - part.linear_velocity) * (2 * grip) + inwards + lift) * part.mass)
    end
  end,
}
