-- Builds a lamp of two parts, finds its parts, and moves the whole lamp.
local lamp = sim:add_body("lamp", { self_collision = false })
lamp:add_part("foot", sim:add_cylinder_shape("foot", 0.15, 0.04), { mass = 2 })
lamp:add_part("arm", sim:add_capsule_shape("arm", 0.02, 0.5), { mass = 0.3, position = vec3(0, 0, 0.3) })
lamp:add_joint("hinge", "foot", "arm", { position = vec3(0, 0, 0.02), axis = vec3(0, 1, 0) })
lamp:add_motor("hinge", { target = 0.4 })
lamp.position = vec3(1, 0, 0)
print(lamp.name, #lamp.parts, #lamp.joints, #lamp.motors) --> lamp 2 1 1
print(lamp.root.name, lamp:part(-1).name, lamp:part("arm").position) --> foot arm vec3(1, 0, 0.3)
print(lamp:joint("hinge").type, lamp:motor(1).target) --> revolute 0.4
