-- Reads a property in an infinite loop.
-- expect: 4-5: stopped
sim:on_step(function()
  local part, sum = sim:body("victim").root, 0
  while true do sum = sum + part.mass + part.position.z end
end)
