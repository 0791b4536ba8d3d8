-- The built-in `target_attraction`, written in Lua: parts are drawn to a point, more strongly from afar.
return behavior {
  doc = "Draws each part to a point, more strongly from afar. (The built-in target_attraction, written in Lua.)",
  params = {
    { "target_pos", vec3(0, 0, 0), unit = "m", doc = "The point, in the world." },
    { "min_dist", 0, min = 0, unit = "m", doc = "Nearer than this nothing acts." },
    { "max_dist", 10, min = 0, unit = "m", doc = "Beyond this nothing acts." },
    { "min_amp", 0, unit = "N", doc = "Force at no distance; negative: away." },
    { "max_amp", 10, unit = "N", doc = "Force at max_dist; negative: away." },
    { "app_interval", 1, min = 0, unit = "ms", doc = "Simulated time between two applications." },
  },
  step = function(self)
    if not self:due("app_interval") or self.max_dist <= 0 then return end
    for _, part in ipairs(self.parts) do
      local r = self.target_pos - part.center
      local d = r:length()
      if d >= self.min_dist and d <= self.max_dist then
        part:apply_force(r:normalized() * (self.min_amp + (self.max_amp - self.min_amp) * d / self.max_dist))
      end
    end
  end,
}
