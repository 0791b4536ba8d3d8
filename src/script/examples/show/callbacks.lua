-- The top level describes the scene. Functions that it registers act while the scene plays.
local ball = sim:add_body("ball")
local part = ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 1) })
sim:on_start(function() print("start at", sim.time) end) --> start at 0
local ticks = 0
sim:on_step(function(dt)
  ticks = ticks + 1
  part:apply_force(vec3(0, 0, 9.81 * part.mass))
  if ticks == 60 then print(string.format("%.4f s, %.1f s", dt, sim.time)) end --> 0.0167 s, 1.0 s
end)
