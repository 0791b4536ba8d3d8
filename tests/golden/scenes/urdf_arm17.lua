-- The long arm with a pose, preserved fixed links, a rotated copy, another root, and a free one that falls.
--@ ticks 100
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local arm = sim:load_urdf("urdf/arm17.urdf", { name = "arm", keep_fixed = true, pose = { joint_2 = 0.4, joint_4 = -0.3 } })
local twin = arm:copy("twin", { position = vec3(1.5, 0, 2), rotation = quat.euler(0.3, 0.2, 2) })
local free = sim:load_urdf("urdf/arm17.urdf", { name = "free", fixed_base = false, motors = "off", position = vec3(-1.5, 0, 1) })
arm:add_behavior("wave", "wave", { rate = 0.8, depth = 0.3 })
twin:add_behavior("random_force", "wind", { max_amp = 10, rand_interval = 200 })
