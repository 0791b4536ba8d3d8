-- Nested coroutines, sorts and replacements.
-- limits: call_ms=10000
-- expect: 5: 100 deep
local function f()
  return coroutine.wrap(function() table.sort({ 1, 2 }, function() ("x"):gsub("x", f) return true end) end)()
end
sim:on_step(function() f() end)
