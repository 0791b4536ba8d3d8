-- Half a megabyte of garbage per tick: no fault, the collector keeps up.
-- limits: memory=16
sim:on_step(function()
  for i = 1, 5000 do local t = { i, i, i } end
end)
