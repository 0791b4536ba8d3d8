-- Attaches a behavior, changes a parameter while it runs, and detaches it.
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("random_force", "wind", { parts = "tip", max_amp = 3, rand_interval = 500 })
sim:after(1, function()
  local wind = arm:behavior("wind")
  print(wind.type, wind.active, wind.max_amp, wind.error) --> random_force true 3 nil
  wind.max_amp = 1
  wind.active = false
end)
sim:after(2, function()
  arm:behavior("wind"):remove()
  print(#arm.behaviors) --> 0
end)
