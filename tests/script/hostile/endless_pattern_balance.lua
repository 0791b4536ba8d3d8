-- Brackets that never close, looked for from each place.
-- expect: 3: takes too many steps|stopped after
sim:on_step(function()
  local text = ("("):rep(200000)
  -- each search alone is a walk to the end
  return text:find("%b()")
end)
