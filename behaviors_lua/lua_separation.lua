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
    for _, part in ipairs(self.parts) do
      -- summed as numbers: a vec3 that lives on from turn to turn would be made anew at each
      local x, y, z, n = 0, 0, 0, 0
      for _, offset, distance in self:neighbors(part, far) do
        if distance >= near then
          local share = distance > 0 and 1 / distance - 1 / far or 0
          x, y, z, n = x + offset.x * share, y + offset.y * share, z + offset.z * share, n + 1
        end
      end
      if n > 0 then part:apply_force(vec3(x, y, z) * (-amount / n)) end
    end
  end,
}
