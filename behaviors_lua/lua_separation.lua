-- The built-in `separation`, written in Lua: keeps each part away from its neighbours in other bodies, the nearest most.
return behavior {
  doc = "Keeps each part away from its neighbours in other bodies. (The built-in separation, written in Lua.)",
  group = true,
  params = {
    { "min_dist", 0, min = 0, max = 1e6, unit = "m", doc = "Neighbours are further away than this" },
    { "max_dist", 1, min = 0, max = 1e6, unit = "m", doc = "and nearer than this." },
    { "amount", 1, min = -1e9, max = 1e9, unit = "N", doc = "Force of a neighbour close by; below 0: towards them." },
  },
  step = function(self)
    local near, far, amount = self.min_dist, self.max_dist, self.amount
    if far <= near then return end
    for _, part in ipairs(self.parts) do part:apply_force(self:neighbor_push(part, near, far) * -amount) end
  end,
}
