-- Finds bodies by name, by number and by pattern.
for i = 1, 3 do sim:add_body("ball" .. i) end
print(sim:body("ball2").name, sim:body(-1).name) --> ball2 ball3
print(sim:find_body("cube")) --> nil
for body in sim:bodies("ball[12]") do
  print(body.name) --> ball1
  --> ball2
end
