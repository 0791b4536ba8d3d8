-- Brackets that are never closed, searched from each position.
-- expect: 3: takes too many steps|stopped after
sim:on_step(function()
  local text = ("("):rep(200000)
  -- each single search scans to the end
  return text:find("%b()")
end)
