-- Mimic joints of a URDF: the hand is closed by the mimicked joints, the fingers press on a ball, then it turns.
--@ ticks 120
local hand = sim:load_urdf("urdf/hand.urdf", { name = "hand" })
local ball = sim:add_sphere_shape("ball", 0.03)
sim:add_body("ball"):add_part("p", ball, { position = hand.root.position + vec3(0, 0.05, 0.9), mass = 0.1 })
sim:on_step(function()
  for i, motor in ipairs(hand.motors) do
    if motor.mode == "servo" then motor.target = 0.6 * math.sin(2 * sim.time + 0.2 * i) end
  end
end)
