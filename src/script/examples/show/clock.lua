-- Beats at 120 per minute: two in a second.
sim.clock.tempo, sim.clock.beats_per_bar = 120, 2
sim:on_beat(function(beat) print("beat", beat, "bar", sim.clock.bar) end)
--> beat 0 bar 0
--> beat 1 bar 0
sim:on_beat(function(beat) print("half", beat) end, 0.5)
--> half 0
--> half 0.5
--> half 1
--> half 1.5
sim:at(0.25, function()
  print(string.format("%.2f %.2f %g", sim.clock.beat, sim.clock.phase, sim.clock.current_tempo)) --> 0.50 0.25 120
end)
sim:on_start(function()
  sim.clock:sync(7, 120) -- follows another clock
  print(sim.clock.beat, sim.clock.synced) --> 7 true
  sim.clock:tap() -- the nearest full beat is now
  sim.clock:start()
  print(sim.clock.beat) --> 0
end)
