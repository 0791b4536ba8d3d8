-- Nods now and then.
return behavior {
  doc = "Nods: a motor goes down and up again, now and then.",
  params = {
    { "depth", 0.6, min = 0, max = 1.5, unit = "rad", doc = "How far it nods." },
    { "pause", 500, min = 100, max = 10000, unit = "ms", doc = "Time from one nod to the next." },
  },
  start = function(self) self.state.down = 0 end,
  step = function(self, dt)
    if self:due("pause") then self.state.down = self.rng:uniform(0.8, 1) end
    self.state.down = self.state.down * math.exp(-dt / 0.3)
    for _, motor in ipairs(self.motors) do motor.target = self.depth * self.state.down end
  end,
}
