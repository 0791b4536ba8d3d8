-- LuaJIT's parser reads an instruction that was not written.
-- expect: 4: the values of a loop can't begin with nil
sim:on_step(function()
  assert(load("\n\n\nlocal _ for _ in (nil):foo() do end", "@scripts/scene.lua"))
end)
