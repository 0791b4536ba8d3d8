-- A stack of heavy boxes on light ones, boxes that start inside each other, an arm inside a wall.
--@ ticks 90
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local box = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
for i = 0, 4 do sim:add_body("stack" .. i):add_part("p", box, { position = vec3(0, 0, 0.1 + 0.2 * i), mass = 10 ^ (i - 1) }) end
for i = 0, 1 do sim:add_body("inside" .. i):add_part("p", box, { position = vec3(1 + 0.05 * i, 0.02 * i, 0.1) }) end
sim:add_body("wall"):add_part("wall", sim:add_box_shape("slab", vec3(0.1, 1, 1)), { mass = 0, position = vec3(2.1, 0, 0.5) })
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm", position = vec3(2, 0.2, 0) })
arm:motor("joint_2").target = 0.8
