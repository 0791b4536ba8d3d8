-- Numbers and tables instead of objects; removed objects.
sim:on_step(function()
  local removed = sim:body("victim"):copy("twin")
  local part, list = removed.root, removed.parts
  removed:remove()
  assert(not removed.alive and not part.alive)
  for _, f in ipairs {
    function() return part.position end, function() part.mass = 2 end, function() part:apply_force(vec3()) end,
    function() return #list end, function() return list[1] end, function() removed:remove() end,
    function() return removed.name end, function() return removed:copy("again") end,
    function() sim:body("healthy"):add_joint("j", part, part) end, function() return sim:body({ slot_ = 0 }) end,
    function() return sim:body(1e300) end, function() return sim:body(0 / 0) end, function() return sim:body(-1e9) end,
  } do
    assert(not pcall(f))
  end
end)
