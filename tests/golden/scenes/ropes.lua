-- Ropes: a light chain with a heavy weight, a chain over a bar, one that is pulled at both ends.
--@ ticks 120
local link, bob = sim:add_capsule_shape("link", 0.02, 0.08), sim:add_sphere_shape("bob", 0.15)
local function rope(name, place, n, weight, fixed)
  local body = sim:add_body(name)
  for i = 0, n do
    body:add_part("p" .. i, link, {
      position = place + vec3(0.12 * i, 0, 0), rotation = quat.euler(0, math.pi / 2, 0), mass = (i == 0 and fixed) and 0 or 0.01,
    })
    if i > 0 then
      body:add_joint("j" .. i, "p" .. i - 1, "p" .. i, { type = "spherical", position = place + vec3(0.12 * i - 0.06, 0, 0) })
    end
  end
  if weight > 0 then
    body:add_part("bob", bob, { position = place + vec3(0.12 * n + 0.2, 0, 0), mass = weight })
    body:add_joint("knot", "p" .. n, "bob", { type = "spherical", position = place + vec3(0.12 * n + 0.06, 0, 0) })
  end
  return body
end
rope("heavy", vec3(0, 0, 3), 15, 20, true)
rope("over", vec3(0, 1, 1.5), 14, 0, false)
sim:add_body("bar"):add_part("bar", sim:add_cylinder_shape("bar", 0.1, 1), { mass = 0, position = vec3(0.7, 1, 1.2), rotation = quat.euler(math.pi / 2, 0, 0) })
local pulled = rope("pulled", vec3(0, 2, 2), 10, 0, true)
sim:on_step(function() pulled:part("p10"):apply_force(vec3(3, math.sin(5 * sim.time), 1)) end)
