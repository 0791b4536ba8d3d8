-- Eight texts of eight megabytes in one operation: LuaJIT tells no place, so it is that of the function.
-- limits: call_ms=10000
-- expect: 5: not enough memory: scripts may hold
local s = ("x"):rep(8e6)
sim:on_step(function()
  local t = s .. s .. s .. s .. s .. s .. s .. s
end)
