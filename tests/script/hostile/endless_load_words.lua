-- Words of a long expression, between which the compiler looks back.
-- expect: 4-6: stopped
local text = "local a x = " .. ("a and "):rep(15000) .. "a"
sim:on_step(function()
  while true do load(text) end
end)
