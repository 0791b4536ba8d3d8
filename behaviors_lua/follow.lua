-- Following: parts are drawn to a target like dogs on a spring; the target comes over OSC as a rule:
--
--   arm:add_behavior("follow", "hand", { parts = "tip" })
--   /physics/body/arm/behavior/hand/target 1.0 0.5 1.2
return behavior {
  doc = "Draws parts to a target that moves: a spring with a damper, as strong as it needs to be up to max_force.",
  params = {
    { "target", vec3(0, 0, 1), unit = "m", doc = "Where to go, in the world. Send it over OSC." },
    { "stiffness", 40, min = 0, max = 1e4, unit = "N/m", doc = "Force for each metre that is missing." },
    { "damping", 8, min = 0, max = 1e3, unit = "N·s/m", doc = "Brakes the way there, so that it doesn't swing past." },
    { "max_force", 50, min = 0, max = 1e4, unit = "N", doc = "The force never exceeds this." },
  },
  step = function(self)
    for _, part in ipairs(self.parts) do
      local force = (self.target - part.center) * self.stiffness - part.linear_velocity * self.damping
      local strength = force:length()
      if strength > self.max_force then force = force * (self.max_force / strength) end
      part:apply_force(force)
    end
  end,
}
