-- The built-in `random_torque`, written in Lua: applies a random torque to each part, which changes at regular
-- intervals.
return behavior {
  doc = "Applies a random torque to each part, which changes at regular intervals. (The built-in, written in Lua.)",
  params = {
    { "min_torque", vec3(-1, -1, -1), min = -1e9, max = 1e9, unit = "N·m", doc = "One corner of the box of random torques, world axes." },
    { "max_torque", vec3(1, 1, 1), min = -1e9, max = 1e9, unit = "N·m", doc = "The other corner." },
    { "scale", 1, min = -1e9, max = 1e9, doc = "Factor on the torque; takes effect at once." },
    { "rand_interval", 1000, min = 0, max = 1e9, unit = "ms", doc = "Simulated time between random draws." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time between applications; shorter than a tick: every tick." },
  },
  start = function(self) self.state.x, self.state.y, self.state.z = {}, {}, {} end,
  step = function(self)
    -- three lists of numbers are faster to read than one of vectors
    local x, y, z = self.state.x, self.state.y, self.state.z
    if self:due("rand_interval") then
      for i in ipairs(self.parts) do
        local torque = self.rng:uniform(self.min_torque, self.max_torque)
        x[i], y[i], z[i] = torque.x, torque.y, torque.z
      end
    end
    if not self:due("app_interval") then return end
    local scale = self.scale
    for i, part in ipairs(self.parts) do part:apply_torque(vec3(x[i], y[i], z[i]) * scale) end
  end,
}
