-- The built-in `torque`, written in Lua: applies a torque to every part.
return behavior {
  doc = "Applies a torque to every part. (The built-in torque, written in Lua.)",
  params = {
    { "torque", vec3(0, 0, 0), min = -1e9, max = 1e9, unit = "N·m", doc = "Torque, world axes." },
    { "scale", 1, min = -1e9, max = 1e9, doc = "Factor on the torque." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time between applications; shorter than a tick: every tick." },
  },
  step = function(self)
    if not self:due("app_interval") then return end
    local torque = self.torque * self.scale
    for _, part in ipairs(self.parts) do part:apply_torque(torque) end
  end,
}
