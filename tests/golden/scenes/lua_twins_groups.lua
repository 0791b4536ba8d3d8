-- The Lua versions of the built-in group behaviors.
--@ ticks 120
sim.gravity = vec3(0, 0, 0)
local ball = sim:add_sphere_shape("ball", 0.05)
for i = 1, 16 do
  local body = sim:add_body("ball" .. i)
  body:add_part("p", ball, {
    mass = 0.1, position = rng:uniform(vec3(-1, -1, 0), vec3(1, 1, 1)), linear_velocity = rng:direction() * 0.5,
    angular_velocity = rng:direction() * 3,
  })
end

sim:add_group_behavior("lua_cohesion", "together", { bodies = "ball*", min_dist = 0.1, max_dist = 1.2, amount = 0.3 })
sim:add_group_behavior("lua_alignment", "flow", { bodies = "ball*", max_dist = 1.5, linear_amount = 0.2, angular_amount = 0.001 })
sim:add_group_behavior("lua_separation", "room", { bodies = "ball*", max_dist = 0.8, amount = 0.4 })
