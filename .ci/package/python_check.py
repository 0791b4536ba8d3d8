"""Checks an installed Python package: python_check.py FOLDER HASH. It must be imported from FOLDER, find its scenes,
reach the hash of `limber play --ticks 120 --seed 3` and draw an image."""

import pathlib
import sys

import limber

folder, expected = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2].split()[1]
module = pathlib.Path(limber.__file__).resolve()
assert module.is_relative_to(folder), module
scenes = limber.data_folder()
sim = limber.Sim(pathlib.Path(scenes) / "scripts/arms.lua", seed=3)
sim.step(120)
assert sim.hash() == int(expected, 16), (hex(sim.hash()), expected)
image = sim.render(320, 180)
assert image.shape == (180, 320, 3) and image.std() > 5, image.std()
with open("/proc/self/maps", encoding="ascii") as file:
    loaded = {line.split()[-1] for line in file if "limber" in line}
libraries = [name for name in loaded if "liblimber.so" in name]
assert libraries and all(pathlib.Path(name).is_relative_to(folder) for name in libraries), libraries
print("ok")
