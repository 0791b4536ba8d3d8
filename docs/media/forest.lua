-- A stand of arms in five colors, with glass among them: for the pictures of both looks. docs/media/make paints
-- urdf/arm17.urdf in these colors.
sim.solver, sim.substeps = "direct", 2
visuals.camera:look_at(vec3(0.3, -7.2, 2.3), vec3(0, 0, 1.05))

local colors = { "violet", "amber", "blue", "red", "green" }
local first, arms = {}, {}
for row = 0, 3 do
  for column = -3, 3 do
    local n = #arms
    local color = colors[(n * n + 3 * row) % #colors + 1]
    local place = vec3(column * 1.3 + 0.45 * math.sin(7 * n), row * 1.6 - 1.9 + 0.5 * math.cos(5 * n), 0)
    local model = first[color]
    local arm = model and model:copy("arm" .. n, { position = place })
      or sim:load_urdf("urdf/" .. color .. ".urdf", { name = "arm" .. n, position = place })
    first[color] = model or arm
    arms[#arms + 1] = arm
  end
end

sim:on_step(function()
  for n, arm in ipairs(arms) do
    for i, motor in ipairs(arm.motors) do
      local phase = 1.3 * n + 0.22 * i * (n % 2 == 0 and 1 or -1)
      motor.target = (0.17 + 0.01 * i) * math.sin(1.1 * sim.time + phase) * math.min(1, sim.time)
    end
  end
end)

local function thing(name, shape, place, color, clear)
  shape.diffuse_color, shape.ambient_color, shape.transparency = color, color, clear
  sim:add_body(name):add_part("it", shape, { mass = 0, position = place })
end
thing("glass", sim:add_sphere_shape("glass", 0.32), vec3(-0.9, -3.3, 0.33), vec3(0.52, 0.35, 0.95), 0.65)
thing("lamp", sim:add_sphere_shape("lamp", 0.5), vec3(-3.2, 4.7, 0.51), vec3(0.06, 0.45, 0.85), 0)
thing("crate", sim:add_box_shape("crate", vec3(1.1, 1.1, 1.1)), vec3(4.9, 4.6, 0.56), vec3(0.05, 0.4, 0.7), 0)
thing("pane", sim:add_box_shape("pane", vec3(0.5, 0.5, 0.5)), vec3(2.1, -3.1, 0.26), vec3(0.03, 0.3, 0.95), 0.6)
