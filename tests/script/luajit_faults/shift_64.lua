-- Shifts of 64-bit numbers give other results in compiled code.
local out = ...
local text = [[
  local out = ...
  for i = 1, 200 do
    out(tonumber(bit.rshift(bit.band(-i, 7LL), 32)), tonumber(bit.rol(bit.band(i, 7LL), 32)))
  end
]]
local chunk = (loadstring or load)(text)
out(chunk ~= nil and pcall(chunk, out))
