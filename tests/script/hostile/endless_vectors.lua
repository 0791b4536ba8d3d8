-- Vector operations in an infinite loop.
-- expect: 5: stopped
sim:on_step(function()
  local v = vec3(1, 0, 0)
  while true do v = quat.euler(0, 0, 0.1) * v:cross(vec3(0, 0, 1)) + vec3(1, 2, 3) * 0.5 end
end)
