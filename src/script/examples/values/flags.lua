-- Switches the motor of a sliding joint on along z only, then reads the three flags.
local body = sim:add_body("lift")
local shape = sim:add_box_shape("block", vec3(0.2, 0.2, 0.2))
body:add_part("base", shape, { mass = 0 })
body:add_part("cabin", shape, { position = vec3(0, 0, 1) })
body:add_joint("rail", "base", "cabin", { type = "prismatic" })
local motor = body:add_motor("rail", { linear_active = { false, false, true } })
print(motor.linear_active.z, motor.linear_active[1]) --> true false
