-- Springs with damping, stiff and soft, and passive damping.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })

for i, m in ipairs(arm.motors) do
  m.mode = "spring"
  m.angular_spring_stiffness, m.angular_spring_damping, m.angular_spring_rest_length = 10 ^ (i - 2), 0.1 * i, 0.3 * i - 1
  m.damping = 0.02 * i
end
sim:every(0.5, function() arm:part("tip"):apply_impulse(vec3(0.3, 0.2, 0.1)) end)
