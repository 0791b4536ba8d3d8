-- The built-in `target_attraction`, written in Lua: pulls each part towards a point, more strongly at larger
-- distances.
return behavior {
  doc = "Pulls each part towards a point. (The built-in target_attraction, written in Lua.)",
  params = {
    { "target_pos", vec3(0, 0, 0), min = -1e6, max = 1e6, unit = "m", doc = "Target point, world." },
    { "min_dist", 0, min = 0, max = 1e6, unit = "m", doc = "Minimal distance at which it acts." },
    { "max_dist", 10, min = 0, max = 1e6, unit = "m", doc = "Maximal distance at which it acts." },
    { "min_amp", 0, min = -1e9, max = 1e9, unit = "N", doc = "Force at distance 0; negative: away from the point." },
    { "max_amp", 10, min = -1e9, max = 1e9, unit = "N", doc = "Force at max_dist." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time between applications; shorter than a tick: every tick." },
  },
  step = function(self)
    if not self:due("app_interval") then return end
    local target, near, far, from, to = self.target_pos, self.min_dist, self.max_dist, self.min_amp, self.max_amp
    for _, part in ipairs(self.parts) do
      local offset = target - part.center
      local d = offset:length()
      if d > 0 and d >= near and d <= far then part:apply_force(offset / d * (from + (to - from) * d / far)) end
    end
  end,
}
