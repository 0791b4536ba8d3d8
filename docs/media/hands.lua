-- For the pictures of docs/reference/panel.md: arms that rest on their springs until the mouse
-- pulls at one, and a misspelt name.
sim.gravity = vec3(0, 0, -9.81)
sim.substeps = 14
visuals.camera:look_at(vec3(0.2, -4.4, 1.9), vec3(0.2, 0, 0.75))

local first = sim:load_urdf("urdf/arm6.urdf", { name = "arm1" })
for _, motor in ipairs(first.motors) do
  motor.mode, motor.angular_spring_stiffness = "spring", 8
end
for i = 2, 6 do
  local place, row = (i - 1) % 4, math.floor((i - 1) / 4)
  first:copy("arm" .. i, { position = vec3(0.9 * place - 1.35 + 0.45 * row, 0.9 * row, 0) })
end
first.position = vec3(-1.35, 0, 0)

sim:at(1, function()
  local height = sim:body("arm2"):part("tipp").position.z
  print("the tip is at", height)
end)
