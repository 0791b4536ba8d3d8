-- A chain of tables that leads to itself.
-- expect: 4: loop
local t = {}
setmetatable(t, { __index = t }) sim:on_step(function() return t.x end)
