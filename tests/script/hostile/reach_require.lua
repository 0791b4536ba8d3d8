-- require of LuaJIT's own modules, and of other folders.
sim:on_step(function()
  for _, name in ipairs { "ffi", "jit", "jit.util", "os", "io", "string.buffer", "../secret", "/etc/passwd", "a/b" } do
    assert(not pcall(require, name), name)
  end
end)
