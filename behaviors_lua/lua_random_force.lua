-- The built-in `random_force`, written in Lua: each part has a force of its own, drawn anew now and then.
return behavior {
  doc = "A random force on each part, drawn anew every rand_interval. (The built-in random_force, written in Lua.)",
  params = {
    { "min_dir", vec3(-1, -1, -1), doc = "A direction is drawn between min_dir and max_dir." },
    { "max_dir", vec3(1, 1, 1), doc = "A direction is drawn between min_dir and max_dir." },
    { "min_amp", 0, unit = "N", doc = "A strength is drawn between min_amp and max_amp." },
    { "max_amp", 10, unit = "N", doc = "A strength is drawn between min_amp and max_amp." },
    { "rand_interval", 1000, min = 0, unit = "ms", doc = "Simulated time between two draws." },
    { "app_interval", 1, min = 0, unit = "ms", doc = "Simulated time between two applications." },
  },
  start = function(self) self.state.forces = {} end,
  step = function(self)
    local forces = self.state.forces
    if self:due("rand_interval") then
      for i in ipairs(self.parts) do
        local dir = self.rng:uniform(self.min_dir, self.max_dir)
        forces[i] = dir:normalized() * self.rng:uniform(self.min_amp, self.max_amp)
      end
    end
    if not self:due("app_interval") then return end
    for i, part in ipairs(self.parts) do part:apply_force(forces[i]) end
  end,
}
