-- Creates bodies in an infinite loop, overlapping the others.
-- expect: 4-7: stopped
sim:on_step(function()
  local n = 0
  while true do
    n = n + 1
    sim:body("healthy"):copy("new " .. n)
  end
end)
