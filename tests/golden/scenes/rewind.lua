-- Rewinds: ticks that are played again reach the same hash, and the show continues from a restored state.
--@ ticks 330
--@ 20 send /push 1
--@ 60 again 30
--@ 100 back 45
--@ 120 send /push -1
--@ 150 again 20
--@ 235 back 100
--@ 240 send /transport/rewind 0.5
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("ground"))
local box, ball = sim:add_box_shape("box", vec3(0.2, 0.25, 0.15)), sim:add_sphere_shape("ball", 0.12)
for i = 1, 9 do
  local stone = sim:add_body("stone" .. i)
  stone:add_part("p", i % 2 == 0 and box or ball, { position = vec3(0.06 * (i % 4), 0.05 * (i % 3), 0.2 + 0.25 * i) })
  stone.parts[1].report_contacts = true
  stone:add_behavior("random_force", "gust", { max_amp = 2 })
end
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm", position = vec3(2, 0, 0) })
arm:add_behavior("breathe", "breath", { rate = 0.8 })
local written, touches = {}, 0
local walk = coroutine.wrap(function()
  local n = 0
  while true do n = (n * 1.25 + rng:uniform(0, 1)) % 3; coroutine.yield(n) end
end)
sim:every(0.1, function() sim:body("stone1").root:apply_impulse(vec3(walk() * 0.02, 0, 0)) end)
sim:on_step(function()
  written[#written + 1] = sim:body("stone3").root.position.z
  if #written % 25 == 0 then
    local sum = touches * 0.01
    for _, z in ipairs(written) do sum = sum + z end
    sim:body("stone4").root:apply_impulse(vec3(sum * 0.001, 0, 0.3))
  end
end)
sim:on_contact(function() touches = touches + 1 end)
osc:on("/push", function(x) state.pushes = (state.pushes or 0) + 1; arm.parts[3]:apply_impulse(vec3(x, 0, state.pushes * 0.1)) end)
