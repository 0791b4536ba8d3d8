-- Applies forces to both bodies in an infinite loop.
-- expect: 4-8: stopped
sim:on_step(function()
  local one, other = sim:body("healthy").root, sim:body("victim").root
  while true do
    one:apply_force(vec3(1, 2, 3))
    other.mass = 5
    one.friction = 0
  end
end)
