-- The built-in `torque`, written in Lua: one constant torque on each part.
return behavior {
  doc = "A constant torque about the world's axes on each part. (The built-in torque, written in Lua.)",
  params = {
    { "torque", vec3(0, 0, 0), unit = "N·m", doc = "About the world's axes." },
    { "scale", 1, doc = "Multiplies the torque." },
    { "app_interval", 1, min = 0, unit = "ms", doc = "Simulated time between two applications." },
  },
  step = function(self)
    if not self:due("app_interval") then return end
    local torque = self.torque * self.scale
    for _, part in ipairs(self.parts) do part:apply_torque(torque) end
  end,
}
