-- More than a megabyte to compile: refused, and it goes on.
sim:on_step(function()
  local f, why = load(("x = 1 "):rep(200000))
  assert(f == nil and why == "load takes up to 1 MB of text")
end)
