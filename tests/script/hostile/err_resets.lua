-- Asks for a reset, then errs: there is none.
-- expect: 3: on purpose
sim:on_step(function() sim:reset() error("on purpose") end)
