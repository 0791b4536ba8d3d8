-- Restitution: balls and boxes that bounce, at different restitution, mass and time step.
--@ ticks 120
--@ 60 send /physics/sim/substeps 2
--@ 90 send /physics/sim/timestep 0.01
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { restitution = 1 })
local ball, box = sim:add_sphere_shape("ball", 0.1), sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
for i = 0, 9 do
  sim:add_body("ball" .. i):add_part("p", ball, { position = vec3(0.5 * i, 0, 0.5 + 0.1 * i), restitution = i / 9 })
  sim:add_body("box" .. i):add_part("p", box, {
    position = vec3(0.5 * i, 1, 0.6), restitution = i / 9, rotation = quat.euler(0.1 * i, 0.05, 0), mass = 2 ^ (i - 5),
  })
end
