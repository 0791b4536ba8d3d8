-- The built-in `speed`, written in Lua: accelerates each part to a given speed in its direction of motion.
return behavior {
  doc = "Accelerates each part to a speed in its direction of motion. (The built-in speed, written in Lua.)",
  params = {
    { "speed", 1, min = -1e4, max = 1e4, unit = "m/s", doc = "Target speed." },
    { "amount", 1, min = -1e9, max = 1e9, unit = "N·s/m", doc = "Force per m/s of difference; negative: away from that speed." },
  },
  step = function(self)
    for _, part in ipairs(self.parts) do
      local v = part.linear_velocity
      part:apply_force(v:normalized() * (self.amount * (self.speed - v:length())))
    end
  end,
}
