-- Listens on another port, and streams the joints of two arms to a renderer thirty times a second.
sim:load_urdf("urdf/arm6.urdf", { name = "left" })
sim:load_urdf("urdf/arm6.urdf", { name = "right", position = vec3(1, 0, 0) })
osc:listen(9103)
osc:stream_to("127.0.0.1:9104", { rate = 30, streams = { "pos", "rot" }, bodies = "*", bundle = 1472 })
