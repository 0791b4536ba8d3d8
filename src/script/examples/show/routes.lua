-- A lamp becomes visible when the tip of a pendulum moves fast.
local ball = sim:add_sphere_shape("ball", 0.1)
local arm = sim:add_body("arm")
arm:add_part("base", ball, { mass = 0, position = vec3(0, 0, 2) })
arm:add_part("tip", ball, { position = vec3(0.8, 0, 2) })
arm:add_joint("hinge", "base", "tip", { position = vec3(0, 0, 2), axis = vec3(0, 1, 0) })
local lamp = sim:add_body("lamp")
lamp:add_part("bulb", ball, { mass = 0, position = vec3(1, 1, 2) })

local glow = sim:add_route("glow", {
  from = { arm:part("tip"), "linear_velocity.length" }, -- or "/physics/body/arm/part/tip/linear_velocity.length"
  to = { lamp:part("bulb"), "transparency" },
  input = { 0, 4 }, output = { 1, 0 }, -- at rest invisible, at 4 m/s opaque
  smoothing = 0.05,
})
sim:after(0.5, function()
  print(#sim.routes, sim:route("glow").from) --> 1 /physics/body/arm/part/tip/linear_velocity.length
  print(glow.input > 1, lamp:part("bulb").transparency == glow.output, glow.problem == "") --> true true true
  glow:remove()
  print(#sim.routes) --> 0
end)
