-- Builds one pendulum, and copies it four times in colors of their own.
local first = sim:add_body("pendulum1")
local ball = sim:add_sphere_shape("ball", 0.05)
first:add_part("anchor", ball, { mass = 0, position = vec3(0, 0, 2) })
first:add_part("bob", ball, { position = vec3(0.5, 0, 2) })
first:add_joint("pin", "anchor", "bob", { position = vec3(0, 0, 2), axis = vec3(0, 1, 0) })
for i = 2, 5 do
  local copy = first:copy("pendulum" .. i, { position = vec3(0, i * 0.3, 2) })
  copy:part("bob").tint = vec3(i / 5, 0.8, 1)
  copy:part("anchor").transparency = 0.5
end
print(#sim.bodies, sim:body("pendulum5"):part("bob").position) --> 5 vec3(0.5, 1.5, 2)
print(sim:body("pendulum3"):part("bob").tint, first:part("bob").tint) --> vec3(0.6, 0.8, 1) vec3(0, 0, 1)
