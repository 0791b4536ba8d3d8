-- require of a missing module.
-- expect: 3: there is no module
sim:on_step(function() require("nothing.here") end)
