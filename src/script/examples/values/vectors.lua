-- Calculates with vectors.
local a, b = vec3(3, 4, 0), vec3(0, 0, 2)
print(a.x, a + b, a * 2) --> 3 vec3(3, 4, 2) vec3(6, 8, 0)
print(a:length(), a:normalized()) --> 5 vec3(0.6, 0.8, 0)
print(a:dot(b), a:cross(b)) --> 0 vec3(8, -6, 0)
print(a:lerp(b, 0.5)) --> vec3(1.5, 2, 1)
print(vec3(), vec3({ 1, 2, 3 }), b / 2) --> vec3(0, 0, 0) vec3(1, 2, 3) vec3(0, 0, 1)
