-- Uses the type nod of behaviors_lua/nod.lua. Its parameters are options, properties and OSC addresses.
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("nod", "yes", { motors = "joint_2", depth = 0.3 })
sim:after(1, function()
  print(arm:behavior("yes").depth, arm:motor("joint_2").target > 0) --> 0.3 true
end)
