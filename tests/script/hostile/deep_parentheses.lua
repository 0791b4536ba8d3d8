-- A text with a hundred thousand brackets: refused, and it goes on.
sim:on_step(function()
  assert(load("return " .. ("("):rep(100000)) == nil)
  assert(load(("do "):rep(100000)) == nil)
  assert(load("x = " .. ("{"):rep(100000)) == nil)
end)
