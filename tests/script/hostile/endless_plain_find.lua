-- A plain text search with almost a match at each position.
-- expect: 4-5: stopped after
sim:on_step(function()
  local text, wanted = ("a"):rep(4000000), ("a"):rep(250) .. "b"
  while true do text:find(wanted, 1, true) end
end)
