-- Turns a direction by 90 degrees about z, half of it, and back.
local quarter = quat.axis(vec3(0, 0, 1), math.pi / 2)
local half = quat():slerp(quarter, 0.5)
local function show(v) print(string.format("%.3f %.3f %.3f", v.x, v.y, v.z)) end
show(quarter * vec3(1, 0, 0)) --> 0.000 1.000 0.000
show(half * vec3(1, 0, 0)) --> 0.707 0.707 0.000
show(quarter:inverse() * (quarter * vec3(1, 0, 0))) --> 1.000 0.000 0.000
show(quat.euler(0, 0, math.pi / 2) * vec3(1, 0, 0)) --> 0.000 1.000 0.000
print(quat(0, 0, 0, 1)) --> quat(0, 0, 0, 1)
