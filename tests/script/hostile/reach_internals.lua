-- Methods called on wrong objects.
sim:on_start(function()
  local part = sim:body("victim").root
  for _, wrong in ipairs { {}, 5, "x", vec3(), sim, sim.bodies, { slot_ = 1, generation_ = 1 }, print, rng, osc } do
    assert(not pcall(part.apply_force, wrong, vec3()))
    assert(not pcall(sim.add_body, wrong, "x") or wrong == sim)
    assert(wrong == rng or not pcall(rng.uniform, wrong))
    assert(not pcall(sim.every, wrong, 1, print) or wrong == sim)
    assert(not pcall(osc.send, wrong, "/x") or wrong == osc)
  end
end)
