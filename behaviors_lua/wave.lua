-- wave: a wave along the motors from root to tip; crests advance by rate × length motors per second.
--
--   worm:add_behavior("wave", "crawl", { rate = 1, length = 6, depth = 0.5 })
return behavior {
  doc = "A wave along the motors; its crests advance by rate × length motors per second.",
  params = {
    { "rate", 0.5, min = -4, max = 4, unit = "Hz", doc = "Frequency; negative: from tip to root." },
    { "length", 6, min = 1, max = 100, doc = "Motors from one crest to the next." },
    { "depth", 0.5, min = 0, max = 1.57, unit = "rad", doc = "Largest deviation." },
    { "growth", 0, min = -1, max = 1, doc = "Change of the amplitude from root to tip; 1: the root is at rest, −1: the tip." },
  },
  start = function(self) self.state.phase = self.state.phase or 0 end,
  step = function(self, dt)
    local s, motors = self.state, self.motors
    s.phase = s.phase + 2 * math.pi * self.rate * dt
    local growth, last = self.growth, math.max(#motors - 1, 1)
    for i, motor in ipairs(motors) do
      local along = (i - 1) / last -- 0 at the root, 1 at the tip
      local share = growth >= 0 and 1 - growth * (1 - along) or 1 + growth * along
      motor.target = share * self.depth * math.sin(s.phase - 2 * math.pi * i / self.length)
    end
  end,
}
