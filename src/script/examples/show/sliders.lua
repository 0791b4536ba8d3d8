-- Sliders for the panel, OSC (/scene/height 1) and presets. The default gives the type.
params {
  { "height", 0.5, min = 0, max = 1.5, step = 0.1, unit = "rad", doc = "How far the arm bends." },
  { "moving", true, doc = "Whether it moves." },
  { "wind", vec3(1, 0, 0), min = -5, max = 5, unit = "N" },
  { "gait", "walk", choices = { "walk", "trot" } },
}
sim:on_step(function()
  if params.moving then state.phase = (state.phase or 0) + params.height end
end)
-- limber send /scene/height 1
sim:after(1, function() print(params.height, params.wind.x, params.gait) end) --> 1 1 walk
