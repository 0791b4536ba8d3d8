-- The built-in `random_torque`, written in Lua: turns each part by a torque of its own that is drawn anew from time to
-- time.
return behavior {
  doc = "Turns each part by a torque of its own, drawn anew from time to time. (The built-in, written in Lua.)",
  params = {
    { "min_torque", vec3(-1, -1, -1), min = -1e9, max = 1e9, unit = "N·m", doc = "One corner of the box that torques are drawn from, world axes." },
    { "max_torque", vec3(1, 1, 1), min = -1e9, max = 1e9, unit = "N·m", doc = "The other corner." },
    { "scale", 1, min = -1e9, max = 1e9, doc = "What the torque is multiplied by; acts at once." },
    { "rand_interval", 1000, min = 0, max = 1e9, unit = "ms", doc = "Simulated time from one random draw to the next." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time from one application to the next; shorter than a tick: every tick." },
  },
  start = function(self) self.state.x, self.state.y, self.state.z = {}, {}, {} end,
  step = function(self)
    -- three lists of numbers are read faster than one of vectors
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
