-- Reading: neighbors, readouts of joints and motors, contacts, lists by patterns; forces that depend on them.
--@ ticks 120
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("random_rotation_target", "fidget", { min_target = vec3(0, 0, -1), max_target = vec3(0, 0, 1), speed = 0.5, rand_interval = 300 })
local ball = sim:add_sphere_shape("ball", 0.06)
for i = 1, 12 do sim:add_body("ball" .. i):add_part("p", ball, { position = rng:uniform(vec3(-0.5, -0.5, 0.2), vec3(0.5, 0.5, 2)), mass = 0.2 }) end
sim:add_group_behavior("flock", "swarm", { bodies = "ball*", radius = 0.6, distance = 0.2 })
sim:on_step(function()
  local sum = vec3()
  for joint in arm:joints("joint_[1-4]") do
    sum = sum + joint.axis * joint.value + joint.relrot * 0.1 + joint.angles * joint.speed * 0.01
    sum = sum + joint.motor.applied_torque * 0.001 + joint.position * 0.01
  end
  for _, body in ipairs(sim.bodies) do sum = sum + body.position * 0.001 + body.root.inertia end
  sum = sum + arm:link("tip").rotation * arm:part(-1).center
  for body in sim:bodies("ball[1-3]") do body.root:apply_force(sum * 0.05) end
end)
