-- The quadruped stands, is pushed, and walks with sine targets; its trunk is kept upright.
--@ ticks 120
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { friction = 1 })
local dog = sim:load_urdf("urdf/quadruped.urdf", { name = "dog", position = vec3(0, 0, 0.40) })
dog:add_behavior("balance", "upright", { parts = "trunk", stiffness = 60, damping = 6 })
sim:on_step(function()
  for i, motor in ipairs(dog.motors) do motor.target = 0.25 * math.sin(8 * sim.time + i) end
end)
sim:at(1, function() dog:part("trunk"):apply_impulse(vec3(1, 3, 0)) end)
