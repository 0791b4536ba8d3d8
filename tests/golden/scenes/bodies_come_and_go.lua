-- Bodies that scripts copy, remove and add while the scene plays; behaviors and groups that follow.
--@ ticks 150
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm0" })
arm:add_behavior("breathe", "breath", { rate = 0.9 })
sim:add_group_behavior("cohesion", "tips", { bodies = "arm*", parts = "tip", amount = 5 })
local ball = sim:add_sphere_shape("ball", 0.1)
local n = 0
sim:every(0.2, function()
  n = n + 1
  if n % 3 == 0 then sim:body("arm0"):copy("arm" .. n, { position = rng:uniform(vec3(-2, -2, 0), vec3(2, 2, 0)) }) end
  sim:add_body("ball" .. n):add_part("p", ball, { position = vec3(0.3 * n, 0.1, 1), mass = 0.1 * n })
  if n > 4 then sim:body("ball" .. n - 4):remove() end
  if n == 9 then sim:body("arm3"):remove() end
end)
