-- Restarts the scene for the message /again. Values that a performer has set stay; state is emptied.
sim:on_start(function() print("start", state.restarts) end)
--> start nil
--> start nil
sim:every(0.1, function() state.restarts = 0 end)
osc:on("/again", function() sim:reset() end)
-- limber send /again
