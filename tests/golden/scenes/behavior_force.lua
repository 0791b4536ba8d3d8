-- The built-in behavior force: a push on the tip and a weaker one on all parts, the second with an interval.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
for motor in arm:motors() do motor.max_angular_force = 30 end

arm:add_behavior("force", "lift", { parts = "tip", dir = vec3(1, 2, 3), amp = 12 })
arm:add_behavior("force", "all", { dir = vec3(-1, 0.3, 0), amp = 3, app_interval = 50 })
