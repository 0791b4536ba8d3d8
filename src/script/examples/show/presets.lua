-- Stores two looks of the show, morphs between them, renames one and deletes it.
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
local motor = arm:motor("joint_2")
motor.bounce = 0
sim:on_start(function() presets:store("calm") end)
sim:after(0.5, function()
  motor.bounce = 0.8
  presets:store("wild", { rows = "/physics/body/arm/motor/*/bounce" })
end)
sim:after(1, function() presets:recall("calm", 0.5, "linear") end)
sim:after(2, function()
  print(motor.bounce, table.concat(presets.names, " ")) --> 0 calm wild
  presets:morph("calm", "wild", 0.5)
end)
sim:after(2.5, function()
  print(motor.bounce) --> 0.4
  presets:rename("wild", "bouncy")
  presets:delete("bouncy")
end)
