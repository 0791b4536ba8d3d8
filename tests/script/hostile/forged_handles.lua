-- Numbers and tables in place of things; things that are gone.
sim:on_step(function()
  local gone = sim:body("victim"):copy("twin")
  local part, list = gone.root, gone.parts
  gone:remove()
  assert(not gone.alive and not part.alive)
  for _, f in ipairs {
    function() return part.position end, function() part.mass = 2 end, function() part:apply_force(vec3()) end,
    function() return #list end, function() return list[1] end, function() gone:remove() end,
    function() return gone.name end, function() return gone:copy("again") end,
    function() sim:body("healthy"):add_joint("j", part, part) end, function() return sim:body({ slot_ = 0 }) end,
    function() return sim:body(1e300) end, function() return sim:body(0 / 0) end, function() return sim:body(-1e9) end,
  } do
    assert(not pcall(f))
  end
end)
