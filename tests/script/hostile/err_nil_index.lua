-- Indexes nil.
-- expect: 4: attempt to index
local arm
sim:on_step(function() return arm.motors end)
