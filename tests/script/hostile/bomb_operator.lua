-- Eight texts of eight megabytes in one operation: LuaJIT gives no place, so the fault has that of the function.
-- limits: call_ms=10000
-- expect: 5: not enough memory: scripts can use
local s = ("x"):rep(8e6)
sim:on_step(function()
  local t = s .. s .. s .. s .. s .. s .. s .. s
end)
