-- Numbers of a run: limber scripts/results.lua --fast --duration 1 --out fall.csv
local ball = sim:add_body("ball")
local part = ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { mass = 1, position = vec3(0, 0, 10) })
sim:record {
  rate = 20,
  { "height", function() return part.position.z end },
  { "speed", function() return part.linear_velocity:length() end },
}
result("fallen", function() return 10 - part.position.z end, { min = 0, max = 10, cells = 5 })
