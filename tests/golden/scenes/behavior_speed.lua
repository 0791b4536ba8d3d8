-- The built-in behavior speed: some balls are accelerated to a speed, others are braked.
--@ ticks 150
sim.gravity = vec3(0, 0, 0)
local ball = sim:add_sphere_shape("ball", 0.05)
for i = 1, 16 do
  local body = sim:add_body("ball" .. i)
  body:add_part("p", ball, {
    mass = 0.1, position = rng:uniform(vec3(-1, -1, 0), vec3(1, 1, 1)), linear_velocity = rng:direction() * 0.5,
    angular_velocity = rng:direction() * 3,
  })
end

for i = 1, 16 do
  sim:body("ball" .. i):add_behavior("speed", "cruise", { speed = i % 3 == 0 and 0 or 0.2 * i, amount = 0.05 * i })
end
