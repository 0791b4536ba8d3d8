-- Compiles more than a megabyte: rejected, and the script continues.
sim:on_step(function()
  local f, why = load(("x = 1 "):rep(200000))
  assert(f == nil and why == "load takes up to 1 MB of text")
end)
