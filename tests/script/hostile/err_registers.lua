-- Registers more callbacks, then raises an error: they are removed.
-- messages: 1
-- expect: 7: on purpose
sim:on_step(function()
  for i = 1, 5 do sim:on_step(function() sim:body("healthy").root:apply_force(vec3(99, 0, 0)) end) end
  sim:after(0.5, function() sim:body("healthy"):remove() end)
  osc:on("/hit", function() sim:body("healthy"):remove() end) error("on purpose")
end)
