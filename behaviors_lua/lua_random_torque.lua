-- The built-in `random_torque`, written in Lua: each part has a torque of its own, drawn anew now and then.
return behavior {
  doc = "A random torque on each part, drawn anew every rand_interval. (The built-in random_torque, written in Lua.)",
  params = {
    { "min_torque", vec3(-1, -1, -1), unit = "N·m", doc = "A torque is drawn between min_torque and max_torque." },
    { "max_torque", vec3(1, 1, 1), unit = "N·m", doc = "A torque is drawn between min_torque and max_torque." },
    { "scale", 1, doc = "Multiplies what was drawn, at once." },
    { "rand_interval", 1000, min = 0, unit = "ms", doc = "Simulated time between two draws." },
    { "app_interval", 1, min = 0, unit = "ms", doc = "Simulated time between two applications." },
  },
  start = function(self) self.state.torques = {} end,
  step = function(self)
    local torques = self.state.torques
    if self:due("rand_interval") then
      for i in ipairs(self.parts) do torques[i] = self.rng:uniform(self.min_torque, self.max_torque) end
    end
    if not self:due("app_interval") then return end
    for i, part in ipairs(self.parts) do part:apply_torque(torques[i] * self.scale) end
  end,
}
