-- Fast rotation: gyroscopic torques, parts that turn further in a substep than Bullet allows, tops on the floor.
--@ ticks 120
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local slab = sim:add_box_shape("slab", vec3(0.3, 0.2, 0.04))
local cone = sim:add_cone_shape("cone", 0.12, 0.25)
for i = 1, 6 do
  sim:add_body("slab" .. i):add_part("p", slab, {
    position = vec3(i, 0, 4 + i), angular_velocity = vec3(0.1, 10 * i, 0.2 * i), mass = 10 ^ (i - 4),
  })
  sim:add_body("top" .. i):add_part("p", cone, {
    position = vec3(i, 1, 0.13), rotation = quat.euler(math.pi + 0.05, 0, 0), angular_velocity = vec3(0, 0, 30 * i),
    spinning_friction = 0.001,
  })
end
local rotor = sim:add_body("rotor")
local base = rotor:add_part("base", slab, { mass = 0, position = vec3(0, 3, 2) })
local disk = rotor:add_part("disk", sim:add_cylinder_shape("disk", 0.2, 0.05), { position = vec3(0, 3, 2.2) })
rotor:add_motor(rotor:add_joint("axle", base, disk, { axis = vec3(0, 0.3, 1) }), { mode = "spin", speed = 300 })
