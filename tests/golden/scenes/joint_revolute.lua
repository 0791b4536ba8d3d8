-- Joints of type revolute: a chain of four, free, with limits, and in both solvers.
--@ ticks 120
--@ 60 send /physics/sim/solver iterative
local box = sim:add_box_shape("box", vec3(0.3, 0.1, 0.1))
local body = sim:add_body("chain")
body:add_part("part0", box, { mass = 0, position = vec3(0, 0, 2) })
for i = 1, 4 do
  body:add_part("part" .. i, box, { mass = 0.3 * i, position = vec3(0.32 * i, 0.02 * i, 2), rotation = quat.euler(0.1 * i, 0, 0.05) })
  local joint = body:add_joint("joint" .. i, "part" .. i - 1, "part" .. i,
    { type = "revolute", position = vec3(0.32 * i - 0.16, 0, 2), axis = vec3(0.2, 1, 0.1 * i) })
  if i > 2 then joint.angular_lower_limit, joint.angular_upper_limit = -0.4, 0.3 end
  joint.angular_stop_cfm = 0.001 * (i - 1)
end
sim:at(0.7, function() body:part("part3"):apply_impulse(vec3(0.5, 0.8, 1)) end)
