-- Lets two parts of a body pass through each other, and collide again.
local body = sim:add_body("pair")
local ball = sim:add_sphere_shape("ball", 0.1)
body:add_part("left", ball)
body:add_part("right", ball, { position = vec3(0.5, 0, 0) })
body:exclude_pair("left", "right")
print(#body.excluded_pairs, body.excluded_pairs[1][2].name) --> 1 right
body:include_pair("left", "right")
print(#body.excluded_pairs) --> 0
