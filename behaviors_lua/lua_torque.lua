-- The built-in `torque`, written in Lua: turns every part about one axis.
return behavior {
  doc = "Turns every part about one axis. (The built-in torque, written in Lua.)",
  params = {
    { "torque", vec3(0, 0, 0), min = -1e9, max = 1e9, unit = "N·m", doc = "About the world's axes." },
    { "scale", 1, min = -1e9, max = 1e9, doc = "What torque is multiplied by." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time from one application to the next; shorter than a tick: every tick." },
  },
  step = function(self)
    if not self:due("app_interval") then return end
    local torque = self.torque * self.scale
    for _, part in ipairs(self.parts) do part:apply_torque(torque) end
  end,
}
