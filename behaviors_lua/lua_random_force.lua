-- The built-in `random_force`, written in Lua: pushes each part in a direction of its own that is drawn anew from time
-- to time.
return behavior {
  doc = "Pushes each part in a direction of its own, drawn anew from time to time. (The built-in, written in Lua.)",
  params = {
    { "min_dir", vec3(-1, -1, -1), min = -1e6, max = 1e6, doc = "One corner of the box that directions are drawn from." },
    { "max_dir", vec3(1, 1, 1), min = -1e6, max = 1e6, doc = "The other corner." },
    { "min_amp", 0, min = -1e9, max = 1e9, unit = "N", doc = "The force is drawn from this" },
    { "max_amp", 10, min = -1e9, max = 1e9, unit = "N", doc = "to this." },
    { "rand_interval", 1000, min = 0, max = 1e9, unit = "ms", doc = "Simulated time from one random draw to the next." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time from one application to the next; shorter than a tick: every tick." },
  },
  start = function(self) self.state.x, self.state.y, self.state.z = {}, {}, {} end,
  step = function(self)
    -- three lists of numbers are read faster than one of vectors
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
