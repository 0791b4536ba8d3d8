-- follow: pulls parts to a target as with a spring; the target usually comes over OSC:
--
--   arm:add_behavior("follow", "hand", { parts = "tip" })
--   /physics/body/arm/behavior/hand/target 1.0 0.5 1.2
--
-- A push that increases until the target is reached compensates weight, springs and other loads.
return behavior {
  doc = "Pulls parts to a moving target with an increasing force, up to max_force.",
  params = {
    { "target", vec3(0, 0, 1), unit = "m", doc = "Target point, world. Send it over OSC." },
    { "stiffness", 40, min = 0, max = 1e4, unit = "N/m", doc = "Force per meter of distance." },
    { "damping", 8, min = 0, max = 1e3, unit = "N·s/m", doc = "Damping against overshoot." },
    { "patience", 2, min = 0.1, max = 100, unit = "s", doc = "Time constant for increasing the force against a resistance." },
    { "max_force", 50, min = 0, max = 1e4, unit = "N", doc = "Limit of the force." },
  },
  start = function(self) self.state.push = {} end,
  step = function(self, dt)
    local push, limit = self.state.push, self.max_force
    for i, part in ipairs(self.parts) do
      local pull = (self.target - part.center) * self.stiffness
      local force = pull - part.linear_velocity * self.damping + (push[i] or vec3())
      local strength = force:length()
      if strength > limit then
        force = force * (limit / strength) -- saturated: stop increasing the push
      else
        push[i] = (push[i] or vec3()) + pull * (dt / self.patience)
      end
      part:apply_force(force)
    end
  end,
}
