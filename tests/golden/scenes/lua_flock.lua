-- The Lua behavior flock: thirty balls.
--@ ticks 120
sim.gravity = vec3()
local ball = sim:add_sphere_shape("ball", 0.04)
for i = 1, 30 do
  sim:add_body("bird" .. i):add_part("p", ball, {
    mass = 0.1, position = rng:uniform(vec3(-1, -1, 0), vec3(1, 1, 2)), linear_velocity = rng:direction(),
  })
end
sim:add_group_behavior("flock", "swarm", { bodies = "bird*", radius = 1.2, distance = 0.3, speed = 1.5 })
