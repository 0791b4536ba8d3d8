-- A hundred nested pcalls, each followed by a loop.
-- expect: 4-8: stopped after
sim:on_step(function()
  local function deep(n)
    if n == 0 then while true do end end
    pcall(deep, n - 1)
    while true do end
  end
  deep(100)
end)
