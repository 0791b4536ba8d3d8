-- Missing globals.
sim:on_step(function()
  for _, name in ipairs { "os", "io", "ffi", "debug", "jit", "package", "module", "dofile", "loadfile", "getfenv",
    "setfenv", "newproxy", "gcinfo", "next", "_G" } do
    assert(not pcall(load("return " .. name)), name)
  end
end)
