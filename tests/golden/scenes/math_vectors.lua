-- vec3, quat and their functions, as results in a parameter and as poses of parts.
--@ ticks 90
params { { "digest", 0 } }
-- bits of a number, folded into the parameter `digest`, which is part of the hash
local function fold(x)
  local text, sum = string.format("%.17g", x), params.digest
  for i = 1, #text do sum = (sum * 31 + text:byte(i)) % 2 ^ 45 end
  params.digest = sum
end
local box = sim:add_box_shape("box", vec3(0.2, 0.1, 0.3))
for i = 1, 6 do
  sim:add_body("box" .. i):add_part("p", box, { position = vec3(i, 0, 0), rotation = quat.euler(0.3 * i, -0.5 * i, 0.7 * i) })
end
sim.gravity = vec3()
sim:on_step(function()
  local t = sim.time + 0.1
  for i = 1, 6 do
    local part = sim:body("box" .. i).root
    local q = quat.axis(vec3(t, i, -1), t * i) * quat.euler(t, 0.2 * i, -t):inverse()
    local v = (part.rotation * vec3(1, t, 0.1)):cross(part.position + vec3(0, 0, 1)):normalized()
    for _, x in ipairs { v.x, v.y, v.z, v:dot(part.center), v:length(), q.x, q.y, q.z, q.w } do fold(x) end
    local to = part.rotation:slerp(q, 0.3)
    fold(to.x + to.w)
    if sim.tick % 20 == i then part.rotation = to end
    part:apply_torque(v * 0.01)
    part:apply_force(v:lerp(vec3(0, 0, 1), 0.2) / (1 + v:length()))
    fold(rgb(math.abs(v.x), math.abs(v.y), math.abs(v.z)).x)
  end
end)
