-- The iterative solver: arms, a rope and boxes that touch them.
--@ ticks 120
sim.solver, sim.solver_iterations, sim.substeps = "iterative", 30, 2
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
for i = 1, 3 do
  local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" .. i, position = vec3(i * 0.5, 0, 0) })
  arm:add_behavior("breathe", "breath", { rate = 0.8, depth = 0.7, offset = i })
end
local box = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
for i = 0, 5 do sim:add_body("box" .. i):add_part("p", box, { position = vec3(0.3 * i, 0.1, 1.5 + 0.1 * i), mass = 0.2 }) end
