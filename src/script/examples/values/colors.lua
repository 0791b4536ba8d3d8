-- Colors are hue, saturation and brightness, each from 0 to 1. rgb() converts from red, green and blue.
print(rgb(1, 0, 0)) --> vec3(0, 1, 1)
print(rgb(0.5, 0.5, 0.5)) --> vec3(0, 0, 0.5)
visuals.background = rgb(0.1, 0.1, 0.2)
