-- The same, caught and repeated.
-- expect: 4-6: stopped after
sim:on_step(function()
  local text = ("a"):rep(5000)
  while true do
    pcall(string.match, text, (".-"):rep(50) .. "b")
  end
end)
