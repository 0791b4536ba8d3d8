-- Random numbers of a scene, of behaviors, with two seeds; noise; shuffles with math.random.
--@ ticks 120
--@ 60 send /physics/sim/seed 77
params { { "digest", 0 } }
-- bits of a number, folded into the parameter `digest`, which is part of the hash
local function fold(x)
  local text, sum = string.format("%.17g", x), params.digest
  for i = 1, #text do sum = (sum * 31 + text:byte(i)) % 2 ^ 45 end
  params.digest = sum
end
sim.gravity = vec3()
local ball = sim:add_sphere_shape("ball", 0.05)
for i = 1, 8 do
  local body = sim:add_body("ball" .. i)
  body:add_part("p", ball, { position = rng:uniform(vec3(-1, -1, -1), vec3(1, 1, 1)) })
  body:add_behavior("random_force", "gust", { rand_interval = 100 })
end
sim:on_step(function()
  for i = 1, 8 do
    local part = sim:body("ball" .. i).root
    local p = part.position
    part:apply_force(vec3(math.noise(p.x, p.y, p.z), math.noise(sim.time, i), math.noise(7 * p.z)))
    part:apply_impulse(rng:direction() * (0.01 * rng:normal()))
  end
  local list = {}
  for i = 1, 20 do list[i] = i end
  for i = 20, 2, -1 do
    local j = math.random(i)
    list[i], list[j] = list[j], list[i]
  end
  fold(list[1] + 20 * list[2] + math.random() + math.random(-5, 5) + rng:uniform(2, 3))
end)
