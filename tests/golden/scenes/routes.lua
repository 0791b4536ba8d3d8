-- Routes: ranges, curves, smoothing, lag, patterns, components, a cycle, and a route that waits for its target.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
local tip = arm:part("tip")
arm:add_behavior("random_force", "wind", { parts = "tip", max_amp = 20, rand_interval = 200 })

sim:add_route("lean", { from = { tip, "linear_velocity.length" }, to = "/physics/body/arm/motor/joint_[1-3]/target",
  input = { 0, 2 }, output = { -0.5, 0.5 }, curve = "smooth", smoothing = 0.1, lag = 0.05 })
sim:add_route("more", { from = { tip, "position.x" }, to = { arm:motor(1), "target" }, combine = "max" })
sim:add_route("there", { from = { tip, "friction" }, to = { tip, "rolling_friction" } })
sim:add_route("back", { from = { tip, "rolling_friction" }, to = { tip, "friction" }, output_high = 1.01 })
sim:add_route("late", { from = { tip, "position.z" }, to = "/physics/body/ball/part/ball/linear_damping" })
sim:after(0.5, function()
  local ball = sim:add_body("ball", { position = vec3(2, 0, 1) })
  ball:add_part("ball", sim:add_sphere_shape("ball", 0.1))
end)
