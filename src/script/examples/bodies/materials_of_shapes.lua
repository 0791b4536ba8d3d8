-- A red, shiny, slightly transparent ball. Colors belong to shapes, so all parts with the shape change together.
local shape = sim:add_sphere_shape("ball", 0.3)
sim:add_body("ball"):add_part("ball", shape)
shape.diffuse_color = rgb(0.9, 0.1, 0.1)
shape.ambient_color = shape.diffuse_color
shape.specular_scale, shape.specular_pow = 2, 80
shape.transparency = 0.1
sim:every(1, function() shape.diffuse_color = vec3(sim.time % 1, 1, 1) end)
print(shape.transparency, visuals:shape("ball") == shape) --> 0.1 true
