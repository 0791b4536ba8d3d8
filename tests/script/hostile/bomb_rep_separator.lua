-- The same with a separator.
-- expect: 3: string.rep makes texts of up to 8 MB
sim:on_step(function() local text = (""):rep(1e9, "xx") end)
