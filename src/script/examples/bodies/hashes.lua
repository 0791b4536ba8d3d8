-- Equal states have equal hashes: two copies that nothing distinguishes stay equal, bit for bit.
local one = sim:add_body("one")
one:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 1) })
sim:after(1, function()
  local before = one:state_hash()
  print(one:state_hash() == before, #sim:state_hash()) --> true 16
end)
