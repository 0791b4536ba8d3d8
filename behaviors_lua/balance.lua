-- balance: keeps parts upright by a torque against each deviation, as if each had a gyroscope inside.
--
--   dog:add_behavior("balance", "upright", { parts = "trunk", stiffness = 60, damping = 6 })
return behavior {
  doc = "Keeps parts upright by a torque, like a gyroscope inside: for trunks, poles, heads.",
  params = {
    { "up", vec3(0, 0, 1), doc = "Direction in the part's frame that shall point up." },
    { "stiffness", 20, min = 0, max = 1e4, unit = "N·m/rad", doc = "Torque per radian of deviation from upright." },
    { "damping", 2, min = 0, max = 1e3, unit = "N·m·s/rad", doc = "Damping of the motion, except of rotation about the vertical." },
    { "max_torque", 50, min = 0, max = 1e4, unit = "N·m", doc = "Limit of the torque." },
  },
  step = function(self)
    local world_up, own_up = vec3(0, 0, 1), self.up:normalized()
    -- upside down, all directions back are equivalent
    local sideways = (math.abs(own_up.x) < 0.9 and vec3(1, 0, 0) or vec3(0, 1, 0)):cross(own_up):normalized()
    for _, part in ipairs(self.parts) do
      local up = part.rotation * own_up
      local turn = up:cross(world_up) -- its length is the sine of the angle from upright
      local sine = turn:length()
      local angle = math.atan2(sine, up:dot(world_up))
      local about = sine > 1e-6 and turn / sine or part.rotation * sideways
      local spin = part.angular_velocity
      local torque = about * (self.stiffness * angle) - (spin - world_up * spin.z) * self.damping
      local strength = torque:length()
      if strength > self.max_torque then torque = torque * (self.max_torque / strength) end
      part:apply_torque(torque)
    end
  end,
}
