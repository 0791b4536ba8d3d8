-- A servo moves to its target; speed is its maximum.
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
local motor = arm:motor("joint_2")
motor.speed = 2
motor.target_smoothing = 0.05
sim:after(0.5, function() motor.target = 0.6 end)
sim:after(2, function()
  print(motor.mode, string.format("%.2f", motor.joint.value)) --> servo 0.60
  print(motor.applied_torque.z ~= 0) --> true
end)
