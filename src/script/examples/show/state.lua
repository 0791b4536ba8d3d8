-- state survives a save of the file; a reset empties it. It holds numbers, text, booleans, vec3s and tables of these.
state.count = state.count or 0
state.places = state.places or {}
sim:every(1, function()
  state.count = state.count + 1
  state.places[state.count] = vec3(state.count, 0, 0)
  print(state.count, #state.places) --> 1 1
  --> 2 2
end)
