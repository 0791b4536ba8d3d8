-- A long expression, for which the compiler looks back at each word.
-- expect: 4-6: stopped
local text = "local a x = " .. ("a and "):rep(15000) .. "a"
sim:on_step(function()
  while true do load(text) end
end)
