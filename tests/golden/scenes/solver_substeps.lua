-- The same chain and boxes with different substeps, time steps and solver iterations, changed while they move.
--@ ticks 120
--@ 20 send /physics/sim/substeps 1
--@ 40 send /physics/sim/substeps 7
--@ 60 send /physics/sim/timestep 0.02
--@ 80 send /physics/sim/solver iterative
--@ 80 send /physics/sim/solver_iterations 5
--@ 100 send /physics/sim/solver direct
--@ 100 send /physics/sim/timestep 0.004
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local worm = sim:load_urdf("urdf/worm.urdf", { name = "worm", position = vec3(0, 0, 0.3) })
worm:add_behavior("wave", "crawl", { rate = 1.5, depth = 0.6 })
local box = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
for i = 0, 5 do
  sim:add_body("box" .. i):add_part("p", box, { position = vec3(1, 0.02 * i, 0.1 + 0.22 * i), rotation = quat.euler(0, 0, 0.1 * i) })
end
