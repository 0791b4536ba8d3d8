-- Brings everything to rest after one second: behaviors and callbacks stop, motors go limp.
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
sim.panic_motors = "limp"
sim:on_step(function()
  if sim.time > 1 and not sim.panicked then sim:panic() end
end)
--> warning: panic: behaviors, forces and callbacks of the …
