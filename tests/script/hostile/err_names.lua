-- Unusual names.
sim:on_step(function()
  for _, name in ipairs { "", ("x"):rep(1e6), "\0", "\n", "\27[2J", "../..", "healthy" } do
    assert(not pcall(sim.add_body, sim, name) or name == "../..")
  end
  sim:body("../.."):remove()
  assert(not pcall(osc.send, osc, "no/slash") and not pcall(osc.on, osc, "/" .. ("x"):rep(2000), print))
end)
