-- A hull with more points than allowed in a callback.
-- limits: call_ms=10000
-- expect: 5: points
local points = {} for i = 1, 20000 do points[i] = vec3(math.sin(i), math.cos(i), math.sin(i * i)) end
sim:on_step(function() sim:add_convex_mesh_shape("hull", points) end)
