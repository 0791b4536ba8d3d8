-- __tostring that formats itself.
-- limits: call_ms=10000
-- expect: 5-6: stack overflow
local t
t = setmetatable({}, { __tostring = function() return ("%s"):format(t) end })
sim:on_step(function() tostring(t) end)
