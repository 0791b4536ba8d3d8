-- The built-in behavior volume: pairs of parts that repel each other.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
for motor in arm:motors() do motor.max_angular_force = 30 end

for motor in arm:motors() do motor.mode = "off" end
arm:add_behavior("volume", "belly", { max_dist = 1.5, max_amp = 25, min_amp = 2 })
