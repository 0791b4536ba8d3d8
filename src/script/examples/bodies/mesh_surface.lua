-- A mesh as ground, ten times as large: others can lie in its hollows, which its convex hull would fill.
local finger = sim:add_mesh_shape("finger", "urdf/meshes/finger.stl", { scale = 10 })
sim:add_body("ground"):add_part("ground", finger)
print(finger.name) --> finger
