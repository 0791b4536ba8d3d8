-- A show of twenty seconds: arms, stones, a worm and a flock, played by messages, floods, console lines, presets,
-- reloads, rewinds, mistakes and a reset. Its take, show.take, is replayed on every platform.
--@ ticks 1200
--@ take
--@ faults 1
--@ 10 send /push 0.3
--@ 20 send /preset/store calm
--@ 30 send /physics/motor/damping arm1 0.3
--@ 40 send /physics/body/arm*/behavior/breath/rate 1.2
--@ 50 send /physics/sim/gravity 0 1 -9
--@ 55 send /preset/store wild
--@ 70 eval sim:body("stone2").root:apply_impulse(rng:direction())
--@ 90 flood 1500 /push 0.0003
--@ 120 send /preset/recall calm 1.5
--@ 150 replace "max_amp = 2" "max_amp = 6"
--@ 200 send /mistake 4
--@ 210 send /transport/rewind_ticks 50
--@ 260 send /scene/wind 0.8
--@ 280 replace "depth = 0.4" "depth = 0.6"
--@ 300 send /scene/count 3
--@ 330 send /spawn extra
--@ 360 flood 4500 /physics/part/friction stone3 0.3
--@ 400 send /preset/recall wild 0.8 in
--@ 480 eval sim.gravity = vec3(0, 0, 3); error("not meant")
--@ 500 send /physics/motor/angularspringstiffness arm2 12
--@ 520 send /edit/undo
--@ 530 send /edit/redo
--@ 560 replace "3 * sim.time" "2.5 * sim.time"
--@ 592 send /transport/rewind 0.3
--@ 600 send /transport/reset
--@ 640 flood 500 /push -0.002
--@ 680 send /physics/sim/solver iterative
--@ 720 send /physics/sim/solver direct
--@ 740 send /physics/sim/substeps 3
--@ 760 send /transport/panic
--@ 800 send /transport/play
--@ 840 send /physics/part/hold stone5 p 0 0 0 0.5 0.5 2
--@ 900 send /gone extra
--@ 905 send /physics/body/arm1/behavior/breath/place 2
--@ 920 reload
--@ 970 send /transport/rewind_ticks 25
--@ 1000 send /preset/morph calm wild 0.6
--@ 1050 send /transport/pause
--@ 1060 send /transport/step 5
--@ 1080 send /transport/play
--@ 1100 flood 700 /push 0.0001
params { { "wind", 0.3, min = 0, max = 1 }, { "count", 2, min = 1, max = 3, rerun = true } }
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("ground"))
local box, ball = sim:add_box_shape("box", vec3(0.2, 0.25, 0.15)), sim:add_sphere_shape("ball", 0.12)
for i = 1, 7 do
  local stone = sim:add_body("stone" .. i)
  stone:add_part("p", i % 2 == 0 and box or ball, { position = vec3(0.06 * (i % 4), 0.05 * (i % 3), 0.2 + 0.25 * i) })
  stone.root.report_contacts = true
  stone:add_behavior("random_force", "gust", { max_amp = 2 })
end
for i = 1, params.count do
  local arm = sim:load_urdf("tests/golden/models/crane.urdf", { name = "arm" .. i, position = vec3(i, 0, 0) })
  arm:add_behavior("breathe", "breath", { depth = 0.4, rate = 0.6, offset = i })
  arm:add_behavior("follow", "hand", { parts = "tip", target = vec3(i, 0.5, 1.2), active = i > 1 })
  if i == 2 then for motor in arm:motors("joint_[12]") do motor.mode, motor.angular_spring_stiffness = "spring", 3 end end
end
local trunk, leg = sim:add_box_shape("trunk", vec3(0.5, 0.2, 0.1)), sim:add_capsule_shape("leg", 0.03, 0.2)
local dog = sim:add_body("dog")
dog:add_part("trunk", trunk, { position = vec3(-1.5, 0, 0.4), mass = 3 })
for i = 1, 4 do
  local place = vec3(-1.5 + (i % 2 == 0 and 0.2 or -0.2), i > 2 and 0.14 or -0.14, 0.26)
  dog:add_part("leg" .. i, leg, { position = place, mass = 0.4, friction = 0.9 })
  local hip = dog:add_joint("hip" .. i, "trunk", "leg" .. i, { position = place + vec3(0, 0, 0.14), axis = vec3(0, 1, 0) })
  hip.angular_lower_limit, hip.angular_upper_limit = vec3(0, 0, -0.8), vec3(0, 0, 0.8)
  dog:add_motor(hip, { max_angular_force = 20 })
end
dog:add_behavior("balance", "upright", { parts = "trunk", stiffness = 60, damping = 6 })
for i = 1, 10 do
  sim:add_body("bird" .. i):add_part("p", ball, { mass = 0.1, position = rng:uniform(vec3(-2, 2, 1), vec3(0, 4, 2)) })
end
sim:add_group_behavior("flock", "swarm", { bodies = "bird*", radius = 1.5, distance = 0.4 })
local touches = 0
sim:on_contact(function(part, other, impulse) touches = touches + math.min(impulse, 1) end)
sim:on_step(function()
  for i, motor in ipairs(dog.motors) do motor.target = 0.2 * math.sin(3 * sim.time + i) end
  for body in sim:bodies("bird*") do body.root:apply_force(vec3(params.wind * math.noise(sim.time), 0, 0.981)) end
end)
sim:every(0.3, function() sim:body("stone4").root:apply_impulse(vec3(0.01 * touches, 0, math.exp(-sim.time) + 0.2)) end)
state.pushes = 0
osc:on("/push", function(x)
  state.pushes = state.pushes + 1
  sim:body("arm1").parts[3]:apply_impulse(vec3(x, rng:uniform(-0.01, 0.01), state.pushes % 7 * 0.001))
end)
osc:on("/mistake", function(x) sim.gravity = vec3(0, 0, x); error("no " .. x) end)
osc:on("/spawn", function(name) sim:body("arm1"):copy(name, { position = vec3(rng:uniform(2, 4), 2, 0) }) end)
osc:on("/gone", function(name) if sim:find_body(name) then sim:body(name):remove() end end)
