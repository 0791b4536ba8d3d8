-- The small wheel turns three times as fast as the large one, in the other direction.
local body = sim:add_body("clock", { self_collision = false })
body:add_part("plate", sim:add_box_shape("plate", vec3(1, 0.02, 0.6)), { mass = 0 })
local function wheel(name, x, radius)
  body:add_part(name, sim:add_cylinder_shape(name, radius, 0.05), { position = vec3(x, 0.1, 0) })
  return body:add_joint(name, "plate", name, { axis = vec3(0, 1, 0) })
end
local large, small = wheel("large", -0.15, 0.3), wheel("small", 0.25, 0.1)
body:add_motor(large, { mode = "spin", speed = 1 })
sim:add_gear(large, small, -3, { name = "drive", max_force = 50 })
sim:after(1, function()
  print(string.format("%.2f %.2f", large.speed, small.speed)) --> 1.00 -3.00
  print(sim:gear("drive").ratio, math.abs(sim:gear(1).error) < 0.001) --> -3 true
  sim:gear("drive"):remove()
  print(#sim.gears) --> 0
end)
