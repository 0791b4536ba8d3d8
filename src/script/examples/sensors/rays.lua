-- A wall with a ball in front of it.
local wall = sim:add_body("wall"):add_part("wall", sim:add_box_shape("wall", vec3(0.2, 4, 4)),
  { position = vec3(3, 0, 0), mass = 0 })
local ball = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.5), { position = vec3(1, 0, 0) })
local hit = sim:ray(vec3(0, 0, 0), vec3(10, 0, 0))
print(hit.part.name, hit.distance, hit.normal) --> ball 0.5 vec3(-1, 0, 0)
print(sim:ray(vec3(0, 0, 0), vec3(10, 0, 0), { ignore = ball }).part.name) --> wall
print(sim:ray(vec3(0, 0, 0), vec3(-10, 0, 0))) --> nil
local distances = sim:rays(vec3(0, 0, 0), { vec3(10, 0, 0), vec3(0, 10, 0) })
print(distances[1], distances[2]) --> 0.5 inf
local parts, how_far = sim:overlap_sphere(vec3(0, 0, 0), 1)
print(#parts, parts[1].name, how_far[1]) --> 1 ball 0.5
