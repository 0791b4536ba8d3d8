-- A duet: a dancer from a BVH file, and an arm that follows her left hand while it copies the bend of her right elbow.
-- Lamps light up near her hands, and a chain of beads coils around her right forearm. motion/dancer.py wrote the dance.
--
-- Try while it runs:   oscsend 127.0.0.1 9003 /physics/mocap/dancer/speed f 0.3
--                      oscsend 127.0.0.1 9003 /physics/mocap/dancer/rotation fff 0 0 90
--                      oscsend 127.0.0.1 9003 /scene/reach f 0.6
--                      oscsend 127.0.0.1 9003 /physics/body/beads/behavior/coil/turns f 5

params {
  { "reach", 0.9, min = 0, max = 3, unit = "m", doc = "Distance from a hand at which lamps light up." },
}

sim.gravity = vec3(0, 0, -9.81)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
visuals.camera:look_at(vec3(2.6, -2.8, 1.7), vec3(0.25, 0, 0.95))

-- The dancer
local dancer = sim:add_mocap("dancer", { source = "motion/dancer.bvh", unit = "cm" })
local figure = dancer:add_body("figure", { radius = 0.055 })
for part in figure:parts() do part.tint = vec3(0.06, 0.5, 0.95) end
figure:part("head_top").tint = vec3(0.08, 0.3, 1)
local left, right = dancer:joint("left_hand"), dancer:joint("right_hand")
local elbow = dancer:joint("right_forearm")

-- The arm: its tip is pulled towards the hand, and its joints copy the elbow
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm", position = vec3(1.1, 0, 0), motors = "servo" })
arm:add_behavior("mocap_target", "copy", {
  motors = "joint_[246]", source = dancer.number, joint = elbow.number, measure = "bend", gain = 0.9, offset = -0.7,
  smoothing = 0.15,
})
arm:add_behavior("mocap_attraction", "follow", {
  parts = "tip", source = dancer.number, joint = left.number, stiffness = 150, damping = 10, max_force = 80,
})

-- Beads that coil around the right forearm
local bead = sim:add_sphere_shape("bead", 0.022)
local beads = sim:add_body("beads", { self_collision = false, gravity_factor = 0 })
for i = 1, 14 do
  beads:add_part("bead_" .. i, bead, { mass = 0.02, position = vec3(-0.8, 0, 1 + 0.05 * i), collision_mask = 0 })
  beads.parts[i].tint = vec3(0.53, 0.7, 0.95)
end
beads:add_behavior("mocap_attraction", "coil", {
  source = dancer.number, joint = elbow.number, to_joint = right.number, radius = 0.11, turns = 3, stiffness = 8,
  damping = 0.4, max_force = 20,
})
local coil = beads:behavior("coil")

-- Lamps on a half ring
local lamp, lamps = sim:add_sphere_shape("lamp", 0.045), sim:add_body("lamps")
for i = 0, 17 do
  local angle = math.pi * i / 17
  lamps:add_part("lamp_" .. i, lamp, {
    mass = 0, position = vec3(0.95 * math.cos(angle), 0.35, 0.7 + 0.95 * math.sin(angle)),
  })
end

sim:on_step(function()
  coil.phase = 2 * sim.time
  for part in lamps:parts() do
    local near = math.min((part.position - left.position):length(), (part.position - right.position):length())
    local light = math.max(0, 1 - near / math.max(params.reach, 0.01))
    part.tint = vec3(0.13, math.min(0.8, light + 0.2), math.min(1, 0.2 + 1.6 * light))
  end
end)
