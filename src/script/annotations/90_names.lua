---@page lua

-- In addition, scripts see the following names of Lua's own libraries, as implemented by LuaJIT:
---@names
