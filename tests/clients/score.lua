-- The scene that all clients control: a hanging arm, a behavior, parameters. /done prints and sends the results.
params {
  { "wind", 0, min = 0, max = 10 }, { "where", vec3(0, 0, 0), min = -10, max = 10 }, { "lively", false },
  { "style", "calm", choices = { "calm", "wild" } },
}
local shape = sim:add_sphere_shape("ball", 0.1)
local arm = sim:add_body("arm")
arm:add_part("base", shape, { mass = 0, position = vec3(1, 2, 3) })
local tip = arm:add_part("tip", shape, { position = vec3(1, 2, 2.5) })
local motor = arm:add_motor(arm:add_joint("elbow", "base", "tip", { position = vec3(1, 2, 3), axis = vec3(0, 1, 0) }))
local push = arm:add_behavior("force", "push", { parts = "tip" })
osc:on("/done", function()
  print("score", sim.gravity.z, tip.friction, tip.restitution, motor.target, push.active, params.style, params.lively,
    params.wind, params.where)
  osc:send("/score", params.wind)
end)
