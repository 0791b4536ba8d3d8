-- Puts a robot on the floor, whatever the height of its origin, and a ball on top of it.
local dog = sim:load_urdf("urdf/quadruped.urdf", { name = "dog" })
dog.position = dog.position - vec3(0, 0, dog:bounds().z)
local low, high = dog:bounds()
sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("dot", 0.05), { position = vec3(0, 0, high.z + 0.05) })
print(math.floor(low.z * 1000 + 0.5), high.z > 0.3) --> 0 true
