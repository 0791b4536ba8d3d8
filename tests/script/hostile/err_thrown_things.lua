-- Throws values that are not text.
-- expect: 5: not text but a table
-- expect: 6: not text but a function
-- expect: 7: not text but a nil
sim:on_step(function() error(setmetatable({}, { __tostring = function() while true do end end })) end)
sim:on_step(function() error(print) end)
sim:on_step(function() error() end)
