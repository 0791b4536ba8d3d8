-- Beats at 120 per minute: two in a second.
sim.clock.tempo, sim.clock.beats_per_bar = 120, 2
sim:on_start(function()
  sim.clock:sync(7, 120) -- follows another clock
  print(sim.clock.beat, sim.clock.synced) --> 7 true
  sim.clock:tap() -- the nearest full beat is now
  sim.clock:start()
  print(sim.clock.beat) --> 0
end)
sim:on_beat(function(beat)
  if beat < 2 then print("beat", beat, "bar", sim.clock.bar) end
end)
--> beat 0 bar 0
--> beat 1 bar 0
sim:on_beat(function(beat)
  if beat == 1.5 then print("half", beat) end --> half 1.5
end, 0.5)
sim:at(0.9, function()
  print(string.format("%.2f %.2f %g", sim.clock.beat, sim.clock.phase, sim.clock.current_tempo)) --> 1.80 0.90 120
end)
