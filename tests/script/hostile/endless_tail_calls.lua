-- Two functions with tail calls to each other.
-- expect: 3-6: stopped after
local f, g
f = function() return g() end
g = function() return f() end
sim:on_step(function() f() end)
