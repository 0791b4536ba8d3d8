-- Presets that are stored, recalled at once and over time, morphed and deleted, by messages and by the scene.
--@ ticks 180
--@ 5 send /preset/store calm
--@ 10 send /physics/body/arm/behavior/breath/rate 1.5
--@ 10 send /physics/motor/damping arm 0.4
--@ 10 send /physics/sim/gravity 0 3 -9
--@ 15 send /preset/store wild
--@ 30 send /preset/recall calm 0.7
--@ 50 send /physics/body/arm/behavior/breath/depth 0.2
--@ 80 send /preset/morph calm wild 0.35
--@ 110 send /preset/recall 1.5 0.5 linear
--@ 130 send /preset/store posed all poses velocities
--@ 150 send /preset/recall posed
--@ 160 send /preset/delete wild
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("breathe", "breath", { rate = 0.5, depth = 0.5 })
for motor in arm:motors("joint_[56]") do motor.mode, motor.angular_spring_stiffness = "spring", 4 end
sim:at(2.1, function() presets:store("late") end)
sim:at(2.4, function() presets:recall("late", 0.4, "in") end)
