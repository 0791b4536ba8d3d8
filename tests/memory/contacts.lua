-- Contacts of all pairs of shapes, with and without joints, and all solver paths: direct, iterative, crowds, too many
-- rows, initial penetration, joints in a singular pose. Prints the state hash twice per second.
params { { "iterative", 0, min = 0, max = 1, rerun = true } }
sim.solver = params.iterative > 0.5 and "iterative" or "direct"

sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local box = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
local ball = sim:add_sphere_shape("ball", 0.1)
local slab = sim:add_box_shape("slab", vec3(0.6, 0.6, 0.2))
local corners = {}
for x = -1, 1, 2 do
  for y = -1, 1, 2 do
    for z = -1, 1, 2 do corners[#corners + 1] = vec3(0.12 * x, 0.1 * y, 0.08 * z + 0.02 * x) end
  end
end
local shapes = {
  ball, box, sim:add_cylinder_shape("cylinder", 0.1, 0.2), sim:add_capsule_shape("capsule", 0.08, 0.2),
  sim:add_cone_shape("cone", 0.12, 0.25), sim:add_convex_mesh_shape("hull", corners),
  sim:add_compound_shape("compound"):add_child(ball, vec3(0.1, 0, 0)):add_child(box, vec3(-0.1, 0, 0)),
}

-- each shape falls on the floor and on each static shape, with friction and restitution
for i, falling in ipairs(shapes) do
  for j, standing in ipairs(shapes) do
    local pair = sim:add_body(("pair_%d_%d"):format(i, j))
    local place = vec3(i, j, 0.2)
    pair:add_part("standing", standing, { mass = 0, position = place })
    pair:add_part("falling", falling, {
      position = place + vec3(0.02, 0.01, 0.32), rotation = quat.euler(0.1, 0.2, 0.3), mass = 1, friction = 0.6,
      rolling_friction = 0.01, restitution = 0.3, angular_velocity = vec3(1, 2, 3),
    })
  end
  local alone = sim:add_body("alone_" .. i)
  alone:add_part("part", falling, { position = vec3(i, -2, 0.16), linear_velocity = vec3(0.5, 0.2, 0) })
end

-- an arm with two hinges; a base with `mass` 0 is static
local function arm(name, place, mass, mode)
  local body = sim:add_body(name)
  local base = body:add_part("base", box, { position = place, mass = mass })
  local upper = body:add_part("upper", box, { position = place + vec3(0.25, 0, 0), mass = 1 })
  local lower = body:add_part("lower", ball, { position = place + vec3(0.5, 0, 0), mass = 0.5 })
  body:add_joint("shoulder", base, upper, { position = place + vec3(0.12, 0, 0), axis = vec3(0, 1, 0) })
  body:add_joint("elbow", upper, lower, { position = place + vec3(0.37, 0, 0), axis = vec3(0, 1, 0) })
  if mode then
    for joint in body:joints("*") do body:add_motor(joint, { mode = mode, target = -0.4, speed = 3 }) end
  end
  return body
end

-- a stack of increasing mass, and arms that press on boxes and on each other
for i = 0, 3 do
  sim:add_body("stack_" .. i):add_part("part", box, { position = vec3(-2, 0, 0.1 + 0.2 * i), mass = 10 ^ i })
end
arm("reaching", vec3(-2, 2, 0.25), 0, "servo")
sim:add_body("reached"):add_part("part", slab, { position = vec3(-1.6, 2, 0.1), mass = 1 })
-- a crowd: several small trees that touch
for i = 0, 5 do arm("crowd_" .. i, vec3(-2 + 0.05 * i, 4, 0.11 + 0.21 * i), 2, i % 2 == 0 and "servo" or nil) end
-- more rows than the direct solver accepts: boxes on a layer of boxes, with an arm among them
for i = 0, 5 do
  for j = 0, 5 do
    for k = 0, 1 do
      local name = ("pile_%d_%d_%d"):format(i, j, k)
      sim:add_body(name):add_part("part", box, { position = vec3(-4 + 0.2 * i, 6 + 0.2 * j, 0.1 + 0.2 * k) })
    end
  end
end
arm("on_the_pile", vec3(-3.6, 6.4, 0.5), 1, "servo")
-- an arm that starts inside a wall, and overlapping boxes
sim:add_body("wall"):add_part("wall", slab, { mass = 0, position = vec3(-3.6, 0, 0.4) })
arm("inside", vec3(-4, 0, 0.4), 0, "spin")
for i = 0, 1 do sim:add_body("inside_" .. i):add_part("part", box, { position = vec3(-4, 2 + 0.03 * i, 0.1) }) end
-- a fixed joint rotated into gimbal lock: the direct solver leaves its island to the iterative solver
local turned = sim:add_body("turned")
turned:add_part("frame", box, { position = vec3(-4, 4, 4) })
local rotor = turned:add_part("rotor", box, { position = vec3(-3.7, 4, 4) })
turned:add_joint("lock", "frame", rotor, { type = "fixed", position = vec3(-3.85, 4, 4), axis = vec3(0, 1, 0) })
rotor.rotation = quat.euler(0, 0, math.pi / 2)

sim:on_step(function()
  if sim.tick % 30 == 10 then print(sim.tick, sim.solver_fallbacks, sim:state_hash()) end
end)
