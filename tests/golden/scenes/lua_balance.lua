-- The Lua behavior balance: poles that are pushed over and come upright again.
--@ ticks 150
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local pole = sim:add_capsule_shape("pole", 0.05, 0.5)
for i = 1, 6 do
  local body = sim:add_body("pole" .. i)
  body:add_part("p", pole, {
    position = vec3(0.5 * i, 0, 0.35), rotation = quat.euler(0.1 * i, -0.07 * i, 0.4), mass = 0.5 + 0.2 * i,
  })
  body:add_behavior("balance", "upright", { stiffness = 10 + i, damping = 0.5, max_torque = 3 })
end
sim:every(0.4, function()
  for i = 1, 6 do sim:body("pole" .. i).root:apply_impulse(rng:direction() * 0.4, vec3(0.5 * i, 0, 0.6)) end
end)
