-- Walks lists by patterns for ever.
-- expect: 4-6: stopped
sim:on_step(function()
  while true do
    for part in sim:body("healthy"):parts("*") do local name = part.name end
  end
end)
