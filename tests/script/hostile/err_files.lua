-- Loads files from a callback that the top level has not loaded.
sim:on_step(function()
  assert(not pcall(sim.load_urdf, sim, "/etc/passwd"))
  assert(not pcall(sim.add_convex_mesh_shape, sim, "m", "/etc/passwd"))
end)
