-- Modifies the libraries of its environment.
-- expect: 8: attempt to call
sim:on_step(function()
  for _, lib in ipairs { string, table, math, coroutine, bit } do
    for name in pairs(lib) do lib[name] = nil end
  end
  pairs, ipairs, error, pcall = nil, nil, nil, nil
  math.sin(1)
end)
