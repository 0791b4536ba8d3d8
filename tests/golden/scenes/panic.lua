-- Panic: everything comes to rest and continues, once from there and once from a checkpoint; motors held and limp.
--@ ticks 200
--@ 40 send /transport/panic
--@ 90 send /transport/play
--@ 110 send /physics/sim/panic_motors limp
--@ 120 send /transport/panic
--@ 150 send /transport/panic
--@ 170 send /transport/play
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("wave", "wave", { rate = 1 })
arm:add_behavior("random_force", "wind", { max_amp = 20 })
local ball = sim:add_sphere_shape("ball", 0.1)
for i = 1, 4 do
  sim:add_body("ball" .. i):add_part("p", ball, { position = vec3(i, 0, 2 * i), linear_velocity = vec3(3, i, 0), angular_velocity = vec3(0, 9, 0) })
end
