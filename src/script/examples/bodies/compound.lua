-- A hammer: a handle with a head, as one rigid part.
local hammer = sim:add_compound_shape("hammer")
hammer:add_child(sim:add_cylinder_shape("handle", 0.02, 0.4))
hammer:add_child(sim:add_box_shape("head", vec3(0.15, 0.06, 0.06)), vec3(0, 0, 0.2))
hammer:add_child("handle", vec3(0, 0, 0.2), quat.axis(vec3(0, 1, 0), math.pi / 2))
local part = sim:add_body("hammer"):add_part("hammer", hammer, { mass = 0.8 })
print(part.center.z > 0.05) --> true
