-- The built-in behavior target_attraction: the tip is attracted by a point, the middle is repelled by another.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
for motor in arm:motors() do motor.max_angular_force = 30 end

arm:add_behavior("target_attraction", "follow", { parts = "tip", target_pos = vec3(1, 0.5, 1), max_amp = 60 })
arm:add_behavior("target_attraction", "flee", { target_pos = vec3(0.2, 0, 1), min_amp = -8, max_amp = -1, max_dist = 2 })
