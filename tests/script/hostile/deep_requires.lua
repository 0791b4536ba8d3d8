-- require of what is not there.
-- expect: 3: there is no module
sim:on_step(function() require("nothing.here") end)
