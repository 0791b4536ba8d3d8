-- A bright studio with soft shadows and without a grid. Light values are factors on those of the style.
local look = visuals.look
look.style = "studio"
look.exposure, look.ambient, look.lamp, look.rim = 1.2, 1.5, 0.8, 0.5
look.shadow, look.fog, look.grid, look.mirror = 0.5, 0, 0, 0
visuals.background = vec3(0.6, 0.1, 0.9)
sim:on_start(function() look:prefer(0) end) -- the stage (0), but only if the scene doesn't set a style
print(look.style, look.floor, look.overlay) --> studio true false
