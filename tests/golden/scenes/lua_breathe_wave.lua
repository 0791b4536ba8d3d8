-- The Lua behaviors breathe and wave: sines that run along the motors of an arm and of a worm.
--@ ticks 150
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("breathe", "breath", { rate = 0.7, depth = 0.5, lag = 0.7 })
local worm = sim:load_urdf("urdf/worm.urdf", { name = "worm", position = vec3(1, 0, 0.06) })
worm:add_behavior("wave", "crawl", { rate = 1, length = 6, depth = 0.5, growth = 0.3 })
