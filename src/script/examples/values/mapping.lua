-- Brings numbers from one range to another.
print(math.clamp(1.7, 0, 1)) --> 1
print(math.lerp(10, 20, 0.25)) --> 12.5
print(math.map(96, 0, 128, -1, 1)) --> 0.5
print(math.noise(0.3) == math.noise(0.3), math.abs(math.noise(7.1, 2.5)) <= 1) --> true true
