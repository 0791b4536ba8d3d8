-- Gears: a train, a rack and pinion, a gear that slips, changes of ratio and removal.
--@ ticks 150
--@ 60 send /physics/gear/train/ratio -1.5
--@ 90 send /physics/gear/slipping/enabled false
local bar = sim:add_box_shape("bar", vec3(0.05, 0.4, 0.05))
local body = sim:add_body("train")
local frame = body:add_part("frame", bar, { mass = 0, position = vec3(0, 0, 1) })
local joints = {}
for i = 1, 4 do
  local part = body:add_part("arm" .. i, bar, { position = vec3(0.5 * i, 0, 1.1), mass = 0.5 })
  joints[i] = body:add_joint("joint" .. i, frame, part, { type = i == 4 and "prismatic" or "revolute", axis = vec3(0.1, 0, 1) })
end
sim:add_gear(joints[1], joints[2], -2, { name = "train" })
sim:add_gear(joints[2], joints[3], 0.7, { name = "slipping", max_force = 0.2 })
local rack = sim:add_gear(joints[1], joints[4], 0.1, { name = "rack" })
local motor = body:add_motor(joints[1])
motor.speed = 3
sim:every(0.5, function() motor.target = 1.2 - motor.target end)
sim:at(2, function() rack:remove() end)
