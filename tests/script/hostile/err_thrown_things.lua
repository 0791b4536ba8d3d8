-- What is thrown is no text.
-- expect: 5: no text but a table
-- expect: 6: no text but a function
-- expect: 7: no text but a nil
sim:on_step(function() error(setmetatable({}, { __tostring = function() while true do end end })) end)
sim:on_step(function() error(print) end)
sim:on_step(function() error() end)
