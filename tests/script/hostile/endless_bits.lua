-- Bit operations in an infinite loop.
-- expect: 5: stopped after
sim:on_step(function()
  local x = 1
  while x ~= 0 do x = bit.bor(bit.rol(x, 1), 1) end
end)
