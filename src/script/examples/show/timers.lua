-- Three kinds of timers, and how to cancel one.
local beat = sim:every(0.5, function() print("beat", string.format("%.1f", sim.time)) end)
--> beat 0.5
--> beat 1.0
sim:after(1.2, function() beat:cancel() end)
sim:at(2, function() print("two seconds") end) --> two seconds
