-- Creates functions in an infinite loop.
-- expect: 5: stopped
sim:on_step(function()
  local f
  while true do local before = f f = function() return before end end
end)
