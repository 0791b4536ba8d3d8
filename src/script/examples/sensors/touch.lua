-- A board that feels where it is loaded.
sim.gravity = vec3(0, 0, -10)
local board = sim:add_body("board"):add_part("board", sim:add_box_shape("board", vec3(2, 1, 0.1)), { mass = 0 })
local left = board:add_touch("left", { position = vec3(-1, 0, 0), radius = 1 })
local right = board:add_touch("right", { position = vec3(1, 0, 0), radius = 1 })
sim:add_body("box"):add_part("box", sim:add_box_shape("box", vec3(0.2, 0.2, 0.2)),
  { position = vec3(-0.5, 0, 0.15), mass = 3 })
sim:after(1, function() print(string.format("%.1f N, %.1f N", left.force, right.force)) end) --> 30.0 N, 0.0 N
