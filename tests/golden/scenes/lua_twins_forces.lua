-- The Lua versions of the built-in behaviors of forces and torques.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
for motor in arm:motors() do motor.max_angular_force = 30 end
arm:add_behavior("lua_force", "force", { parts = "tip", dir = vec3(1, 2, 3), amp = 12 })
arm:add_behavior("lua_torque", "torque", { torque = vec3(0.3, 0.1, 0.7), scale = 2 })
arm:add_behavior("lua_random_force", "wind", { max_amp = 20, rand_interval = 150 })
arm:add_behavior("lua_random_torque", "shiver", { scale = 2.5, rand_interval = 90 })
arm:add_behavior("lua_target_attraction", "follow", { parts = "tip", target_pos = vec3(1, 0.5, 1), max_amp = 60 })
arm:add_behavior("lua_speed", "speed", { parts = "tip", speed = 2, amount = 3 })
arm:add_behavior("lua_volume", "belly", { max_dist = 1.5, max_amp = 15 })
