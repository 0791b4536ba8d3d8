-- Iterates over lists by pattern in an infinite loop.
-- expect: 4-6: stopped
sim:on_step(function()
  while true do
    for part in sim:body("healthy"):parts("*") do local name = part.name end
  end
end)
