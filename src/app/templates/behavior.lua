-- {{NAME}}: every motor follows a slow sine, each a little later than the one before. A scene gives it to a body with
--
--     body:add_behavior("{{NAME}}", "my_{{NAME}}", { rate = 0.5 })

return behavior {
  doc = "Every motor follows a slow sine, each a little later than the one before.",

  -- In this order in the panel. Every instance has its own values: self.rate, self.depth, self.lag.
  params = {
    { "rate", 0.25, min = 0, max = 4, unit = "Hz", doc = "Waves per second." },
    { "depth", 0.4, min = 0, max = 1.57, unit = "rad", doc = "Largest deviation." },
    { "lag", 0.5, min = 0, max = 6.28, unit = "rad", doc = "Delay from one motor to the next." },
  },

  -- Before the first step and after each reset. What must last from step to step belongs into self.state.
  start = function(self) self.state.phase = 0 end,

  -- In each tick while it is active; dt is the time that the tick takes, in seconds.
  step = function(self, dt)
    local state = self.state
    -- a phase that is summed up, so that a new rate does not make the motors jump
    state.phase = state.phase + 2 * math.pi * self.rate * dt
    for i, motor in ipairs(self.motors) do
      motor.target = self.depth * math.sin(state.phase - i * self.lag)
    end
  end,
}
