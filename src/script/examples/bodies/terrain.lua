-- Hills from a function: a ray finds a summit and a valley, and a ball falls on a slope and rolls away.
local hills = sim:add_heightfield_shape("hills", {
  size = { 14, 14 }, rows = 113, columns = 113,
  heights = function(x, y) return 0.5 * math.cos(x) * math.cos(y) end,
})
sim:add_body("ground"):add_part("ground", hills)
local function height(x) return sim:ray(vec3(x, 0, 5), vec3(x, 0, -5)).position.z end
print(string.format("%.2f %.2f", height(0), height(math.pi))) --> 0.50 -0.50

sim.gravity = vec3(0, 0, -9.81)
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0.8, 0, 0.6) })
sim:after(0.9, function() print(ball.position.x > 1.2, ball.position.z < 0.3) end) --> true true
