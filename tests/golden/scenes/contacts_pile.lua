-- A pile of boxes and balls: more rows than the direct solver accepts, with an arm on top.
--@ ticks 60
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local box, ball = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2)), sim:add_sphere_shape("ball", 0.1)
for i = 0, 4 do
  for j = 0, 4 do
    for k = 0, 2 do
      sim:add_body(("pile_%d_%d_%d"):format(i, j, k)):add_part("p", (i + j + k) % 3 == 0 and ball or box,
        { position = vec3(0.201 * i, 0.202 * j, 0.1 + 0.205 * k) })
    end
  end
end
local worm = sim:load_urdf("urdf/worm.urdf", { name = "worm", position = vec3(0, 0.4, 0.75) })
worm:add_behavior("wave", "crawl", { rate = 1 })
