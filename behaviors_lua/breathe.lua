-- Breathing: a slow sine goes through the motors, each a little later than the one before.
--
--   arm:add_behavior("breathe", "breath", { rate = 0.2, depth = 0.4 })
return behavior {
  doc = "Every motor follows a slow sine, each a little later than the one before.",
  params = { -- in this order in the panel
    { "rate", 0.25, min = 0, max = 4, unit = "Hz", doc = "Breaths per second." },
    { "depth", 0.6, min = 0, max = 1.57, unit = "rad", doc = "Largest deviation." },
    { "lag", 0.5, min = 0, max = 6.28, unit = "rad", doc = "Delay from one motor to the next." },
    { "offset", 0, min = -6.28, max = 6.28, unit = "rad", doc = "Delay of the whole: two bodies need not breathe together." },
  },
  start = function(self) self.state.phase = self.state.phase or 0 end,
  step = function(self, dt)
    -- a phase that is summed up, so that a new rate does not make the motors jump
    local s = self.state
    s.phase = s.phase + 2 * math.pi * self.rate * dt
    for i, motor in ipairs(self.motors) do
      motor.target = self.depth * math.sin(s.phase - self.offset - i * self.lag)
    end
  end,
}
