-- Balancing: parts are kept upright as if each had a gyroscope inside; what pushes them over is met by a torque.
--
--   dog:add_behavior("balance", "upright", { parts = "trunk", stiffness = 60, damping = 6 })
return behavior {
  doc = "Keeps parts upright by a torque, like a gyroscope inside: for trunks, poles, heads.",
  params = {
    { "up", vec3(0, 0, 1), doc = "Which way of the part, in its own frame, is to point up." },
    { "stiffness", 20, min = 0, max = 1e4, unit = "N·m/rad", doc = "Torque for each radian off upright." },
    { "damping", 2, min = 0, max = 1e3, unit = "N·m·s/rad", doc = "Brakes the way back; turning about the upright stays free." },
    { "max_torque", 50, min = 0, max = 1e4, unit = "N·m", doc = "The torque never exceeds this." },
  },
  step = function(self)
    local world_up, own_up = vec3(0, 0, 1), self.up:normalized()
    -- upside down, every way back is as good
    local sideways = (math.abs(own_up.x) < 0.9 and vec3(1, 0, 0) or vec3(0, 1, 0)):cross(own_up):normalized()
    for _, part in ipairs(self.parts) do
      local up = part.rotation * own_up
      local turn = up:cross(world_up) -- its length is the sine of the angle off upright
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
