-- The built-in `force`, written in Lua: one constant force on each part.
return behavior {
  doc = "A constant force on each part. (The built-in force, written in Lua.)",
  params = {
    { "dir", vec3(1, 0, 0), doc = "Direction of the force; its length does not matter." },
    { "amp", 0, unit = "N", doc = "Strength; negative: against dir." },
    { "max_amp", 1e4, min = 0, unit = "N", doc = "The strength never exceeds this." },
    { "app_interval", 1, min = 0, unit = "ms", doc = "Simulated time between two applications." },
  },
  step = function(self)
    if not self:due("app_interval") then return end
    local force = self.dir:normalized() * math.clamp(self.amp, -self.max_amp, self.max_amp)
    for _, part in ipairs(self.parts) do part:apply_force(force) end
  end,
}
