-- Closed loops: a four-bar linkage with a motor, and a ring of links that falls on the floor.
--@ ticks 120
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local bar = sim:add_box_shape("bar", vec3(0.05, 0.05, 0.4))
local four = sim:add_body("four")
local frame = four:add_part("frame", bar, { mass = 0, position = vec3(0, 0, 1) })
local left = four:add_part("left", bar, { position = vec3(-0.3, 0, 1.2) })
local right = four:add_part("right", bar, { position = vec3(0.3, 0, 1.2) })
local top = four:add_part("top", bar, { position = vec3(0, 0, 1.4), rotation = quat.euler(0, math.pi / 2, 0) })
local y = vec3(0, 1, 0)
local crank = four:add_joint("crank", frame, left, { position = vec3(-0.3, 0, 1), axis = y })
four:add_joint("rocker", frame, right, { position = vec3(0.3, 0, 1), axis = y })
four:add_joint("upper_left", left, top, { position = vec3(-0.3, 0, 1.4), axis = y })
four:add_joint("upper_right", right, top, { position = vec3(0.3, 0, 1.4), axis = y })
four:add_motor(crank, { mode = "spin", speed = 1 })
local ring, n = sim:add_body("ring"), 10
for i = 0, n - 1 do
  local a = 2 * math.pi * i / n
  ring:add_part("p" .. i, bar, {
    position = vec3(2 + 0.65 * math.cos(a), 0.65 * math.sin(a), 0.8), rotation = quat.euler(math.pi / 2, 0, a), mass = 0.2,
  })
end
for i = 0, n - 1 do
  local a = 2 * math.pi * (i + 0.5) / n
  ring:add_joint("j" .. i, "p" .. i, "p" .. (i + 1) % n,
    { type = i % 2 == 0 and "spherical" or "revolute", position = vec3(2 + 0.68 * math.cos(a), 0.68 * math.sin(a), 0.8) })
end
