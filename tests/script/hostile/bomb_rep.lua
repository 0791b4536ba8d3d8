-- A text of a gigabyte.
-- expect: 3: string.rep makes texts of up to 8 MB
sim:on_step(function() local text = ("x"):rep(1e9) end)
