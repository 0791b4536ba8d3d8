-- The built-in `alignment`, written in Lua: accelerates each part towards the motion of its neighbors in other
-- bodies.

-- Limits a gain so that one tick changes the velocity of an inertia by at most the difference; more would overshoot
-- and diverge.
local function limited_gain(gain, inertia, dt) return math.clamp(gain, -inertia / dt, inertia / dt) end

-- Limits the gain about each principal axis separately: a thin part allows less about its long axis than across it.
local function limited_torque(part, gain, spin, dt)
  local inertia = part.inertia
  if math.abs(gain) * dt <= math.min(inertia.x, inertia.y, inertia.z) then return spin * gain end
  local axes = part.principal_axes
  local local_spin = axes:inverse() * spin
  return axes * vec3(
    local_spin.x * limited_gain(gain, inertia.x, dt),
    local_spin.y * limited_gain(gain, inertia.y, dt),
    local_spin.z * limited_gain(gain, inertia.z, dt))
end

return behavior {
  doc = "Accelerates each part towards the motion of its neighbors in other bodies. (The built-in alignment, written in Lua.)",
  group = true,
  params = {
    { "min_dist", 0, min = 0, max = 1e6, unit = "m", doc = "Minimal distance of neighbors." },
    { "max_dist", 10, min = 0, max = 1e6, unit = "m", doc = "Maximal distance of neighbors." },
    { "linear_amount", 1, min = -1e9, max = 1e9, unit = "N·s/m", doc = "Force per m/s of difference, limited to the force that removes it in one tick." },
    { "angular_amount", 1, min = -1e9, max = 1e9, unit = "N·m·s/rad", doc = "Torque per rad/s of difference, limited to the torque that removes it in one tick." },
    { "amount", 1, min = -1e9, max = 1e9, doc = "Factor on both; negative: away from the neighbors' motion." },
  },
  step = function(self, dt)
    local near, far = self.min_dist, self.max_dist
    if far <= near then return end
    for _, part in ipairs(self.parts) do
      local n, offset, velocity, spin = self:neighbor_means(part, near, far)
      if n > 0 then
        local s = self.amount * math.clamp(1 - (offset:length() - near) / (far - near), 0, 1)
        part:apply_force(velocity * limited_gain(self.linear_amount * s, part.mass, dt))
        part:apply_torque(limited_torque(part, self.angular_amount * s, spin, dt))
      end
    end
  end,
}
