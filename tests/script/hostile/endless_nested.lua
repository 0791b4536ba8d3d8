-- Nested infinite loops.
-- expect: 5-8: stopped after
sim:on_step(function()
  local n = 0
  while true do
    for i = 1, 10 do
      for k = 1, 10 do n = n + i * k end
    end
  end
end)
