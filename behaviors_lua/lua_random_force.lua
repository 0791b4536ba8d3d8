-- The built-in `random_force`, written in Lua: applies a random force to each part, with a new direction and
-- magnitude at regular intervals.
return behavior {
  doc = "Applies a random force to each part, which changes at regular intervals. (The built-in, written in Lua.)",
  params = {
    { "min_dir", vec3(-1, -1, -1), min = -1e6, max = 1e6, doc = "One corner of the box of random directions." },
    { "max_dir", vec3(1, 1, 1), min = -1e6, max = 1e6, doc = "The other corner." },
    { "min_amp", 0, min = -1e9, max = 1e9, unit = "N", doc = "Lower bound of the random force." },
    { "max_amp", 10, min = -1e9, max = 1e9, unit = "N", doc = "Upper bound of the random force." },
    { "rand_interval", 1000, min = 0, max = 1e9, unit = "ms", doc = "Simulated time between random draws." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time between applications; shorter than a tick: every tick." },
  },
  start = function(self) self.state.x, self.state.y, self.state.z = {}, {}, {} end,
  step = function(self)
    -- three lists of numbers are faster to read than one of vectors
    local x, y, z = self.state.x, self.state.y, self.state.z
    if self:due("rand_interval") then
      for i in ipairs(self.parts) do
        local dir = self.rng:uniform(self.min_dir, self.max_dir)
        local force = dir:normalized() * self.rng:uniform(self.min_amp, self.max_amp)
        x[i], y[i], z[i] = force.x, force.y, force.z
      end
    end
    if not self:due("app_interval") then return end
    for i, part in ipairs(self.parts) do part:apply_force(vec3(x[i], y[i], z[i])) end
  end,
}
