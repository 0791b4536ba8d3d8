-- A chain of __index tables that forms a loop.
-- expect: 4: loop
local t = {}
setmetatable(t, { __index = t }) sim:on_step(function() return t.x end)
