-- The built-in `separation`, written in Lua: pushes each part away from its neighbors in other bodies.
return behavior {
  doc = "Pushes each part away from its neighbors in other bodies. (The built-in separation, written in Lua.)",
  group = true,
  params = {
    { "min_dist", 0, min = 0, max = 1e6, unit = "m", doc = "Minimal distance of neighbors." },
    { "max_dist", 1, min = 0, max = 1e6, unit = "m", doc = "Maximal distance of neighbors." },
    { "amount", 1, min = -1e9, max = 1e9, unit = "N", doc = "Force of a neighbor at distance 0; negative: towards it." },
  },
  step = function(self)
    local near, far, amount = self.min_dist, self.max_dist, self.amount
    if far <= near then return end
    for _, part in ipairs(self.parts) do part:apply_force(self:neighbor_push(part, near, far) * -amount) end
  end,
}
