-- Use of objects as arrays, pointers and other structs.
sim:on_step(function()
  local part = sim:body("victim").root
  for _, f in ipairs {
    function() return part[0] end, function() return part[1e9] end, function() part.slot_ = 5 end,
    function() return part + 1 end, function() return #part end, function() return part < part end,
    function() return part() end, function() return -part end, function() return part.x.y end,
    function() return vec3().slot_ end, function() vec3().x = 5 end, function() sim.bodies.slot_ = 5 end,
    function() return part .. "x" end, function() return rng[1] end, function() return quat()[0] end,
  } do
    assert(not pcall(f))
  end
end)
