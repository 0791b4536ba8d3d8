-- The built-in `alignment`, written in Lua: gives each part the motion of its neighbours in other bodies.

-- a gain that within a tick brings an inertia to the mean and no further: what is more would overshoot, and grow
local function bounded(gain, inertia, dt) return math.clamp(gain, -inertia / dt, inertia / dt) end

-- about each principal axis by itself: a thin part takes less about its long axis than across
local function bounded_torque(part, gain, spin, dt)
  local inertia = part.inertia
  if math.abs(gain) * dt <= math.min(inertia.x, inertia.y, inertia.z) then return spin * gain end
  local axes = part.principal_axes
  local own = axes:inverse() * spin
  return axes * vec3(
    own.x * bounded(gain, inertia.x, dt), own.y * bounded(gain, inertia.y, dt), own.z * bounded(gain, inertia.z, dt))
end

return behavior {
  doc = "Gives each part the motion of its neighbours in other bodies. (The built-in alignment, written in Lua.)",
  group = true,
  params = {
    { "min_dist", 0, min = 0, max = 1e6, unit = "m", doc = "Neighbours are further away than this" },
    { "max_dist", 10, min = 0, max = 1e6, unit = "m", doc = "and nearer than this." },
    { "linear_amount", 1, min = -1e9, max = 1e9, unit = "N·s/m", doc = "Force for each m/s that differs; never more than ends the difference." },
    { "angular_amount", 1, min = -1e9, max = 1e9, unit = "N·m·s/rad", doc = "Torque for each rad/s that differs; never more than ends the difference." },
    { "amount", 1, min = -1e9, max = 1e9, doc = "What both are multiplied by; below 0: away from the neighbours' motion." },
  },
  step = function(self, dt)
    local near, far = self.min_dist, self.max_dist
    if far <= near then return end
    for _, part in ipairs(self.parts) do
      local n, way, velocity, spin = self:neighbor_means(part, near, far)
      if n > 0 then
        local s = self.amount * math.clamp(1 - (way:length() - near) / (far - near), 0, 1)
        part:apply_force(velocity * bounded(self.linear_amount * s, part.mass, dt))
        part:apply_torque(bounded_torque(part, self.angular_amount * s, spin, dt))
      end
    end
  end,
}
