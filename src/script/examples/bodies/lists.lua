-- Walks through lists. A list is indexed from 1; called with a pattern, it gives the objects with matching names.
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
print(#arm.motors, arm.motors[2].name) --> 6 joint_2
for i, joint in ipairs(arm.joints) do
  if i > 2 then break end
  print(i, joint.name) --> 1 joint_1
  --> 2 joint_2
end
local count = 0
for motor in arm:motors("joint_[1-3]") do count = count + 1 end
for part in arm:parts() do part.linear_damping = 0.1 end
print(count, #sim.bodies, #sim.gears, #arm.behaviors, #arm.sensors, #arm.tendons) --> 3 1 0 0 0 0
print(#sim.fixtures, #sim.routes) --> 0 0
