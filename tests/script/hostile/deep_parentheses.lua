-- Compiles a hundred thousand brackets: rejected, and the script continues.
sim:on_step(function()
  assert(load("return " .. ("("):rep(100000)) == nil)
  assert(load(("do "):rep(100000)) == nil)
  assert(load("x = " .. ("{"):rep(100000)) == nil)
end)
