-- The built-in `force`, written in Lua: pushes every part in one direction.
return behavior {
  doc = "Pushes every part in one direction. (The built-in force, written in Lua.)",
  params = {
    { "dir", vec3(1, 0, 0), min = -1e6, max = 1e6, doc = "Where to, world; its length does not matter." },
    { "amp", 0, min = -1e9, max = 1e9, unit = "N", doc = "How hard; below 0: the other way." },
    { "max_amp", 1e4, min = 0, max = 1e9, unit = "N", doc = "What amp is held below, either way." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time from one application to the next; shorter than a tick: every tick." },
  },
  step = function(self)
    if not self:due("app_interval") then return end
    local force = self.dir:normalized() * math.clamp(self.amp, -self.max_amp, self.max_amp)
    for _, part in ipairs(self.parts) do part:apply_force(force) end
  end,
}
