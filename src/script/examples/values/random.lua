-- Scatters ten balls. Each run with the same seed gives the same numbers.
sim.seed = 7
local shape = sim:add_sphere_shape("ball", 0.05)
for i = 1, 10 do
  local ball = sim:add_body("ball" .. i, { position = rng:uniform(vec3(-1, -1, 0), vec3(1, 1, 2)) })
  ball:add_part("ball", shape, { linear_velocity = rng:direction() * 0.5 })
end
print(rng:uniform() < 1, rng:uniform(5, 6) >= 5, type(rng:normal())) --> true true number
