-- Access through the metatable of strings.
sim:on_step(function()
  assert(getmetatable("") == "string")
  assert(not pcall(setmetatable, "", {}))
  assert(("").dump == nil and ("").buffer == nil)
  string.upper = nil
  assert(("x"):upper() == "X")
end)
