-- The body of quadruped.xml on a plane, with the springs of its actuators. With `drive`, the scene itself sets the
-- targets before each tick, and reads the angles, the speeds and the state of the trunk after it.
sim.gravity = vec3(0, 0, -9.81)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { friction = 1 })
local dog = sim:load_urdf("quadruped.xml", { name = "dog" })
for part in dog:parts() do part.friction = 0.8 end
params { { "drive", 0, min = 0, max = 1, doc = "1: the scene sets the targets." } }

local motors, joints, trunk = {}, {}, dog:part("trunk")
for _, leg in ipairs { "front_left", "front_right", "back_left", "back_right" } do
  for _, name in ipairs { "hip", "thigh", "knee" } do
    local motor = dog:motor(leg .. "_" .. name)
    motor.mode = "spring"
    motors[#motors + 1], joints[#joints + 1] = motor, dog:joint(leg .. "_" .. name)
  end
end

-- A trot on the spot of two steps a second, in steps of 1/240 s; steps.h has the same table.
local CYCLE = 120
local actions = {}
for step = 1, CYCLE do
  local row = {}
  for leg = 0, 3 do
    local phase = 2 * math.pi * ((step - 1) / CYCLE + ((leg == 0 or leg == 3) and 0 or 0.5))
    local lift = math.max(0, math.sin(phase))
    row[3 * leg + 1], row[3 * leg + 2], row[3 * leg + 3] = 0, -0.5 - 0.15 * lift, 1 + 0.3 * lift
  end
  actions[step] = row
end

local observation, count = {}, 0
sim:on_step(function(dt)
  if params.drive == 0 then return end
  for i = 1, #joints do observation[i], observation[12 + i] = joints[i].value, joints[i].speed end
  observation[25], observation[26] = trunk.position, trunk.rotation
  observation[27], observation[28] = trunk.linear_velocity, trunk.angular_velocity
  local row = actions[count % CYCLE + 1]
  count = count + math.floor(240 * dt + 0.5)
  for i = 1, #motors do motors[i].target = row[i] end
end)
