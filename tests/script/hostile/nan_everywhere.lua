-- NaN and infinity for all numbers.
sim:on_step(function()
  local nan, part, body = 0 / 0, sim:body("healthy").root, sim:body("healthy")
  for _, bad in ipairs { nan, math.huge, -math.huge } do
    for _, f in ipairs {
      function() part.mass = bad end, function() part.position = vec3(bad, 0, 0) end,
      function() part.rotation = quat(bad, 0, 0, 1) end, function() part:apply_force(vec3(0, bad, 0)) end,
      function() part:apply_impulse(vec3(0, 0, 1), vec3(bad, 0, 0)) end, function() body.position = vec3(bad, 0, 0) end,
      function() sim.gravity = vec3(bad, 0, 0) end, function() sim.timestep = bad end,
      function() sim:every(bad, print) end, function() sim:after(bad, print) end,
      function() osc:send("/x", bad) end, function() sim:add_sphere_shape("s" .. tostring(bad), bad) end,
      function() body:add_part("p", "ball", { mass = bad }) end, function() math.random(bad) end,
      function() sim.bodies[bad].x = 1 end,
    } do
      assert(not pcall(f))
    end
  end
  local t = {}
  assert(not pcall(rawset, t, nan, 1))
  assert(string.rep("x", nan) == "" and ("x"):sub(nan) == "x")
end)
