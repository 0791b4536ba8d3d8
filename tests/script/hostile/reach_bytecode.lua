-- Handmade bytecode.
sim:on_step(function()
  for _, text in ipairs { "\27LJ\2\2\0", "\27LJ\1", "\27Lua", "\27" } do
    assert(load(text) == nil and loadstring(text) == nil)
  end
  assert(string.dump == nil)
  assert(not pcall(load, function() return nil end))
end)
