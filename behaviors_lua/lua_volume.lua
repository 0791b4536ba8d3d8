-- The built-in `volume`, written in Lua: pushes the two parts of each pair apart, so that a body keeps its volume.
-- (The built-in type pairs parts in the order in which the scene names them; here it is the order from root to tip.)
return behavior {
  doc = "Pushes the two parts of each pair apart. (The built-in volume, written in Lua.)",
  params = {
    { "max_dist", 1, min = 0, max = 1e6, unit = "m", doc = "Maximal distance at which it acts." },
    { "min_amp", 0, min = -1e9, max = 1e9, unit = "N", doc = "Force at max_dist." },
    { "max_amp", 10, min = -1e9, max = 1e9, unit = "N", doc = "Force at distance 0; negative: towards each other." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time between applications; shorter than a tick: every tick." },
  },
  step = function(self)
    if not self:due("app_interval") then return end
    local parts, far, from, to = self.parts, self.max_dist, self.min_amp, self.max_amp
    for i = 1, #parts - 1, 2 do
      local first, second = parts[i], parts[i + 1]
      local offset = second.center - first.center
      local d = offset:length()
      if d > 0 and d <= far then
        local force = offset / d * (from + (to - from) * (1 - d / far))
        first:apply_force(-force)
        second:apply_force(force)
      end
    end
  end,
}
