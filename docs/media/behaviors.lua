-- Four arms, each with another behavior, for their picture in docs/reference/behaviors.md. The debug overlay shows what
-- they do.
visuals.camera:look_at(vec3(1.2, -4.6, 1.7), vec3(1.2, 0, 0.65))
visuals.look.overlay = true
sim.substeps = 10

local function arm(name, x)
  local body = sim:load_urdf("urdf/arm6.urdf", { name = name, position = vec3(x, 0, 0) })
  for _, motor in ipairs(body.motors) do motor.mode = "spring"; motor.angular_spring_stiffness = 3 end
  return body
end
arm("force", -0.6):add_behavior("force", "push", { parts = "tip", dir = vec3(1, 0, 0), amp = 10 })
arm("random_force", 0.6):add_behavior("random_force", "wind", { parts = "tip", min_amp = 2, max_amp = 4, rand_interval = 400 })
arm("target_attraction", 1.8):add_behavior("target_attraction", "reach",
  { parts = "tip", target_pos = vec3(2.3, -0.3, 1.0), max_amp = 4, min_amp = 2 })
arm("torque", 3):add_behavior("torque", "twist", { parts = "all", torque = vec3(0, 2, 0) })
