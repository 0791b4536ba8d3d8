-- A replacement function that never returns.
-- expect: 4: stopped after
sim:on_step(function()
  local text = ("abc"):gsub("%w", function() while true do end end)
end)
