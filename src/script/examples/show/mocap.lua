-- A dancer from a BVH file moves a body of capsules; a ball is attracted to the left hand.
local dancer = sim:add_mocap("dancer", { source = "scripts/motion/dancer.bvh", unit = "cm", offset = vec3(0, 1, 0) })
print(#dancer.joints, dancer.duration, dancer:joint("left_hand").parent.name) --> 20 8 left_forearm
local figure = dancer:add_body("figure", { radius = 0.05 })
print(figure:part("left_hand").motion, string.format("%.2f m", dancer:joint("left_hand").length)) --> kinematic 0.25 m

local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.05), { mass = 0.1, position = vec3(0, 1, 2) })
ball:add_behavior("mocap_attraction", "pull", {
  source = dancer.number, joint = dancer:joint("left_hand").number, stiffness = 50, damping = 2,
})

-- a second source receives rigid bodies by OSC; the address contains their names
local actor = sim:add_mocap("actor", {
  messages = { ["/rigid/<joint>/pose"] = "x y z qx qy qz qw" }, up = "y", unit = "mm", joints = { "hat", "cane" },
})
print(actor:joint("hat").age, #sim.mocaps, sim:mocap("actor").joints[2].name) --> -1 2 cane

sim:after(0.9, function()
  local hand = dancer:joint("left_hand")
  print(hand.confidence, (ball.root.position - hand.position):length() < 0.2) --> 1 true
  print(dancer.expansion > 0.3, dancer.symmetry > 0.3, dancer.tracked) --> true true true
end)
