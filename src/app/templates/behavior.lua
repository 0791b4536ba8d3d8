-- {{NAME}}: moves the motors with a slow sine wave, each slightly later than the previous one. Add it to a body with
--
--     body:add_behavior("{{NAME}}", "my_{{NAME}}", { rate = 0.5 })

return behavior {
  doc = "Moves the motors with a slow sine wave, each slightly later than the previous one.",

  -- The panel shows them in this order. Every instance has its own values: self.rate, self.depth, self.lag.
  params = {
    { "rate", 0.25, min = 0, max = 4, unit = "Hz", doc = "Waves per second." },
    { "depth", 0.4, min = 0, max = 1.57, unit = "rad", doc = "Amplitude." },
    { "lag", 0.5, min = 0, max = 6.28, unit = "rad", doc = "Delay from one motor to the next." },
  },

  -- Called before the first step and after each reset. Keep values that persist between steps in self.state.
  start = function(self) self.state.phase = 0 end,

  -- Called in each tick while the behavior is active; dt is the duration of the tick in seconds.
  step = function(self, dt)
    local state = self.state
    -- integrate the phase, so that a new rate does not make the motors jump
    state.phase = state.phase + 2 * math.pi * self.rate * dt
    for i, motor in ipairs(self.motors) do
      motor.target = self.depth * math.sin(state.phase - i * self.lag)
    end
  end,
}
