-- Rays without an end.
-- expect: 8: stopped
local body = sim:add_body("far_ball")
body:add_part("ball", sim:add_sphere_shape("far_ball", 0.5), { position = vec3(50, 0, 0) }):add_touch("skin")
local targets = {}
for i = 1, 1000 do targets[i] = vec3(100, i, 0) end
sim:on_step(function()
  while true do sim:rays(vec3(0, 0, 0), targets) end
end)
