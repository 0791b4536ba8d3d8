-- Access to other scripts' tables through functions, load and metatables.
sim:on_step(function()
  assert(not pcall(setmetatable, osc, {}) and not pcall(setmetatable, params, {}))
  assert(not pcall(load, "return 1", "n", "t", 5))
  assert(getmetatable(sim) == "ffi" and getmetatable(osc) == "osc")
  assert(load("return sim", "n", "t", {})() == nil)
  assert(not pcall(rawset, osc, "send", 1) and not pcall(rawset, params, "wind", 1))
  assert(pcall(osc.send, osc, "/x"))
end)
