-- Following: parts are drawn to a target as if on a spring; the target comes over OSC as a rule:
--
--   arm:add_behavior("follow", "hand", { parts = "tip" })
--   /physics/body/arm/behavior/hand/target 1.0 0.5 1.2
--
-- What holds a part back (its weight, springs, a load) is met by a push that grows until the target is reached.
return behavior {
  doc = "Draws parts to a target that moves, as strongly as it takes, up to max_force.",
  params = {
    { "target", vec3(0, 0, 1), unit = "m", doc = "Where to go, in the world. Send it over OSC." },
    { "stiffness", 40, min = 0, max = 1e4, unit = "N/m", doc = "Force for each metre that is missing." },
    { "damping", 8, min = 0, max = 1e3, unit = "N·s/m", doc = "Brakes the way there, so that it doesn't swing past." },
    { "patience", 2, min = 0.1, max = 100, unit = "s", doc = "How soon it pushes harder against what holds it back; longer: more gently." },
    { "max_force", 50, min = 0, max = 1e4, unit = "N", doc = "The force never exceeds this." },
  },
  start = function(self) self.state.push = {} end,
  step = function(self, dt)
    local push, most = self.state.push, self.max_force
    for i, part in ipairs(self.parts) do
      local missing = (self.target - part.center) * self.stiffness
      local force = missing - part.linear_velocity * self.damping + (push[i] or vec3())
      local strength = force:length()
      if strength > most then
        force = force * (most / strength) -- as strong as it gets: pushing harder can wait
      else
        push[i] = (push[i] or vec3()) + missing * (dt / self.patience)
      end
      part:apply_force(force)
    end
  end,
}
