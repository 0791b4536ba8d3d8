-- ripple: waves that run outward from a point, for joints that move up and down.
return behavior {
  doc = "Moves each motor by the waves that run outward from a point.",
  params = {
    { "rate", 0.4, min = 0, max = 3, unit = "Hz", doc = "Waves per second." },
    { "depth", 0.25, min = 0, max = 0.4, unit = "m", doc = "Height of the waves." },
    { "length", 1.6, min = 0.2, max = 10, unit = "m", doc = "Distance from one wave to the next." },
    { "center", vec3(0, 0, 0), unit = "m", doc = "Point where the waves begin." },
  },
  start = function(self) self.state.phase = 0 end,
  step = function(self, dt)
    self.state.phase = self.state.phase + self.rate * dt
    for _, motor in ipairs(self.motors) do
      local way = motor.joint.position - self.center
      local distance = math.sqrt(way.x ^ 2 + way.y ^ 2)
      local wave = math.sin(2 * math.pi * (self.state.phase - distance / self.length))
      motor.target = self.depth * wave
    end
  end,
}
