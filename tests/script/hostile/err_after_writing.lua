-- Changes its own and the healthy body, then raises an error.
-- expect: 12: on purpose
sim:on_step(function()
  for _, name in ipairs { "healthy", "victim" } do
    local body = sim:body(name)
    body.position = vec3(9, 9, 9)
    body.linear_velocity = vec3(9, 9, 9)
    body.root.mass = 50
    body.root:apply_impulse(vec3(100, 100, 100))
    rng:uniform()
  end
  error("on purpose")
end)
