-- The built-in `speed`, written in Lua: what moves is led to one speed, what rests stays at rest.
return behavior {
  doc = "Accelerates or brakes each part along its own way, towards one speed. (The built-in speed, written in Lua.)",
  params = {
    { "speed", 1, unit = "m/s", doc = "The speed to reach." },
    { "amount", 1, unit = "N·s/m", doc = "Force for each m/s that is missing." },
  },
  step = function(self)
    for _, part in ipairs(self.parts) do
      local v = part.linear_velocity
      part:apply_force(v:normalized() * (self.amount * (self.speed - v:length())))
    end
  end,
}
