-- A moving head that hangs at 3 m and follows a ball.
local ball = sim:add_body("ball")
ball:add_part("tip", sim:add_sphere_shape("tip", 0.1), { mass = 0, position = vec3(1, -1, 2) })
local spot = sim:add_fixture("spot", {
  profile = "moving_spot", address = 1, targets = ball:part("tip"),
  position = vec3(0, 0, 3), rotation = vec3(180, 0, 0),
  dimmer = 1, rgb = vec3(1, 0.5, 0),
})
print(spot.profile, spot.aim, #spot.targets, #sim.fixtures) --> moving_spot part 1 1
sim:after(0.9, function()
  print(string.format("%.2f %.2f", spot.pan, spot.tilt)) --> 45.00 54.74
  print(spot.pan_dmx, spot.tilt_dmx, spot.dmx) --> 38229 46053 149 85 179 229 255 255 255 128 0 0 96 0
  sim:fixture("spot"):remove()
  print(spot.alive) --> false
end)
