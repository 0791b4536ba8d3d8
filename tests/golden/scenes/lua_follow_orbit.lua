-- The Lua behaviors follow and orbit: an arm's tip follows a moving target, balls circle around a point.
--@ ticks 150
--@ 60 send /physics/body/arm/behavior/hand/target 0.6 0.4 1.2
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("follow", "hand", { parts = "tip", target = vec3(0.5, -0.3, 1.5) })
local ball = sim:add_sphere_shape("ball", 0.05)
for i = 1, 5 do
  local moon = sim:add_body("moon" .. i)
  moon:add_part("p", ball, { mass = 0.2, position = vec3(2 + 0.1 * i, 0.3 * i, 1) })
  moon:add_behavior("orbit", "round",
    { center = vec3(2, 0, 1), axis = vec3(0.1 * i, 0.2, 1), radius = 0.3 * i, speed = 1.5, lift = i % 2 == 0 })
end
