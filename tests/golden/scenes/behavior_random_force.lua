-- The built-in behavior random_force: random gusts several times a second.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
for motor in arm:motors() do motor.max_angular_force = 30 end

arm:add_behavior("random_force", "wind", { max_amp = 20, rand_interval = 150, min_dir = vec3(-1, -0.5, -1) })
