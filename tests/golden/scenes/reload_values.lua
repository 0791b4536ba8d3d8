-- Reloads: values, objects that are added and removed, shapes and poses that change, while the scene plays.
--@ ticks 160
--@ 20 replace "mass = 0.5" "mass = 0.8"
--@ 40 replace "local count = 4" "local count = 7"
--@ 60 send /physics/part/friction ball2 0.05
--@ 70 replace "friction = 0.7" "friction = 0.9"
--@ 90 replace "local count = 7" "local count = 3"
--@ 110 replace "0.08)" "0.12)"
--@ 130 replace "0, 0, -9.81" "0.5, 0, -5"
local count = 4
sim.gravity = vec3(0, 0, -9.81)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { friction = 0.7 })
local ball = sim:add_sphere_shape("ball", 0.08)
for i = 1, count do
  local body = sim:add_body("ball" .. i)
  body:add_part("p", ball, { mass = 0.5, position = vec3(0.1 * i, 0.02 * i, 0.3 * i) })
  body:add_behavior("force", "push", { dir = vec3(1, 0, 0), amp = 0.1 * i })
end
