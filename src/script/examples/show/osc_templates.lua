-- Streams the parts of an arm as a motion capture system does: y up, centimeters, rotations with w first.
sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
osc:stream_to("127.0.0.1:9104", {
  rate = 120,
  messages = {
    { address = "/mocap/{body}/{index}/pos", objects = "/physics/body/*/part/*", scale = 100,
      values = { "{name}", "position.x", "position.z", "-position.y" } },
    { address = "/mocap/{body}/rot", objects = "/physics/body/*/part/*", per = "body",
      values = { "rotation.w", "rotation.x", "rotation.z", "-rotation.y" } },
  },
})
