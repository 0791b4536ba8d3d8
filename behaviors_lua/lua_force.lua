-- The built-in `force`, written in Lua: applies a force to every part.
return behavior {
  doc = "Applies a force to every part. (The built-in force, written in Lua.)",
  params = {
    { "dir", vec3(1, 0, 0), min = -1e6, max = 1e6, doc = "Direction, world; its length has no influence." },
    { "amp", 0, min = -1e9, max = 1e9, unit = "N", doc = "Force; negative: opposite direction." },
    { "max_amp", 1e4, min = 0, max = 1e9, unit = "N", doc = "Limit of the magnitude of amp." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time between applications; shorter than a tick: every tick." },
  },
  step = function(self)
    if not self:due("app_interval") then return end
    local force = self.dir:normalized() * math.clamp(self.amp, -self.max_amp, self.max_amp)
    for _, part in ipairs(self.parts) do part:apply_force(force) end
  end,
}
