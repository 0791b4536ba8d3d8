-- The built-in `volume`, written in Lua: parts two by two push each other apart, and so keep a body's volume.
return behavior {
  doc = "Parts two by two push each other apart when they are near. (The built-in volume, written in Lua.)",
  params = {
    { "max_dist", 1, min = 0, unit = "m", doc = "Beyond this nothing acts." },
    { "min_amp", 0, unit = "N", doc = "Force at max_dist; negative: together." },
    { "max_amp", 10, unit = "N", doc = "Force at no distance; negative: together." },
    { "app_interval", 1, min = 0, unit = "ms", doc = "Simulated time between two applications." },
  },
  step = function(self)
    if not self:due("app_interval") or self.max_dist <= 0 then return end
    local parts = self.parts
    for i = 1, #parts - 1, 2 do
      local first, second = parts[i], parts[i + 1]
      local r = second.center - first.center
      local d = r:length()
      if d <= self.max_dist then
        local push = r:normalized() * (self.min_amp + (self.max_amp - self.min_amp) * (1 - d / self.max_dist))
        first:apply_force(-push)
        second:apply_force(push)
      end
    end
  end,
}
