-- The built-in `speed`, written in Lua: drives each part to a speed, along the way that it goes.
return behavior {
  doc = "Drives each part to a speed, along the way that it goes. (The built-in speed, written in Lua.)",
  params = {
    { "speed", 1, min = -1e4, max = 1e4, unit = "m/s", doc = "The speed to reach." },
    { "amount", 1, min = -1e9, max = 1e9, unit = "N·s/m", doc = "Force for each m/s that is missing; below 0: away from that speed." },
  },
  step = function(self)
    for _, part in ipairs(self.parts) do
      local v = part.linear_velocity
      part:apply_force(v:normalized() * (self.amount * (self.speed - v:length())))
    end
  end,
}
