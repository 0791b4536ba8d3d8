-- breathe: moves the motors with a slow sine wave, each slightly later than the previous one.
--
--   arm:add_behavior("breathe", "breath", { rate = 0.2, depth = 0.4 })
return behavior {
  doc = "Moves the motors with a slow sine wave, each slightly later than the previous one.",
  params = { -- in this order in the panel
    { "rate", 0.25, min = 0, max = 4, unit = "Hz", doc = "Breaths per second." },
    { "depth", 0.6, min = 0, max = 1.57, unit = "rad", doc = "Largest deviation." },
    { "lag", 0.5, min = 0, max = 6.28, unit = "rad", doc = "Phase delay between successive motors." },
    { "offset", 0, min = -6.28, max = 6.28, unit = "rad", doc = "Phase of the whole, so that bodies need not move in unison." },
  },
  start = function(self) self.state.phase = self.state.phase or 0 end,
  step = function(self, dt)
    -- integrate the phase, so that a new rate doesn't make the motors jump
    local s = self.state
    s.phase = s.phase + 2 * math.pi * self.rate * dt
    for i, motor in ipairs(self.motors) do
      motor.target = self.depth * math.sin(s.phase - self.offset - i * self.lag)
    end
  end,
}
