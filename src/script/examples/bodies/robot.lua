-- Loads an arm that is fixed to the floor, and a dog with one bent leg beside it.
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
local dog = sim:load_urdf("urdf/quadruped.urdf", {
  name = "dog", pose = { front_left_thigh = 0.5 }, position = vec3(2, 0, 0.5), motors = "off",
})
print(#arm.motors, arm:motor("joint_2").mode, dog:motor(1).mode) --> 6 servo off
print(string.format("%.2f rad", dog:joint("front_left_thigh").value)) --> 0.50 rad
print(arm:link("tip").position.z > 1) --> true
