-- The same from the hundredth tick on; until then it does not change the healthy body.
-- expect: 11: on purpose
local n = 0
sim:on_step(function()
  n = n + 1
  if n < 100 then return end
  local body = sim:body("healthy")
  body.rotation = quat.euler(1, 2, 3)
  body:reset()
  body:remove()
  error("on purpose")
end)
