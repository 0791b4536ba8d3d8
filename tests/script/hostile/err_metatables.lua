-- Invalid metatables.
sim:on_step(function()
  local liar = setmetatable({}, { __index = function() return 0 / 0 end, __metatable = "none", __mode = "kv",
    __len = function() return 1e9 end, __gc = function() while true do end end })
  assert(#liar == 0)
  local part = sim:body("healthy").root
  assert(not pcall(function() part.position = liar end))
  assert(not pcall(function() part:apply_force(liar) end))
  assert(not pcall(sim.add_body, sim, "x", setmetatable({ [liar] = 1 }, {})))
  assert(tostring(setmetatable({}, { __tostring = function() return "mine" end })) == "mine")
end)
