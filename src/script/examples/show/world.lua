-- The world's properties: gravity of the moon, finer steps, half the speed of real time.
sim.gravity = vec3(0, 0, -1.62)
sim.substeps = 8
sim.speed = 0.5
sim.seed = 42
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 2) })
sim:after(1, function()
  print(string.format("%.2f s, tick %d, %.2f m", sim.time, sim.tick, ball.position.z)) --> 1.00 s, tick 60, 1.19 m
  print(sim.solver, sim.paused, sim.sleeping_parts) --> direct false 0
end)
