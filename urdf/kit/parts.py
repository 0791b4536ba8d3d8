"""The parts that all models are assembled from, and their densities.

Every part extends from z = 0 along +z, unless it is "centered". Densities are those of a printed shell with its
contents, hence lower than that of solid plastic.
"""

import math

from kit.solid import arc, lathe, mass_properties, rounded_box

BLOCK = 0.12  # edge of the joint block, m
LINK = 0.45  # length of the long tube, m
LINK_SHORT = 0.24  # length of the short tube, m
TUBE = 0.05  # radius of both tubes, m
BASE_HEIGHT = 0.06  # m
PLATE = (0.05, 0.23, 0.20)  # the palm: thick, wide, high, m
TRUNK = (0.46, 0.18, 0.11)  # m
TIP = 0.16  # length of the tip, m
LEG = 0.22  # from joint to joint, m
LEG_TOP, LEG_BOTTOM = 0.034, 0.026  # radii of the leg's ends, m
SEGMENT, SEGMENT_RADIUS = 0.05, 0.05  # the worm's capsule: between the caps' centers, radius, m
FINGER, FINGER_RADIUS = 0.09, 0.022  # likewise, from joint to joint


def tube(length, rings):
    """A tube that looks stacked from `rings` rings, with rounded rims and a groove between two."""
    profile, pitch = [(0, 0)], length / rings
    for k in range(rings):
        low, high = k * pitch, (k + 1) * pitch
        profile += [] if k else [(TUBE - 0.006, low)]
        profile += [(TUBE - 0.0015, low + 0.003), (TUBE, low + 0.009)]
        profile += [(TUBE, high - 0.009), (TUBE - 0.0015, high - 0.003), (TUBE - 0.006, high)]
    return lathe(profile + [(0, length)])


def capsule(length, bottom, top, sides):
    """Two balls at z = 0 and z = length and the straight skin that touches both."""
    lean = math.asin((bottom - top) / length)
    profile = arc(0, 0, bottom, -math.pi / 2, lean, 6) + arc(0, length, top, lean, math.pi / 2, 6)
    return lathe(profile, sides)


def base():
    """A disc with a collar, the base of fixed models."""
    profile = [(0, 0), (0.114, 0)] + arc(0.112, 0.008, 0.008, -math.pi / 4, 0, 2)
    profile += arc(0.108, 0.034, 0.012, 0, math.pi / 2, 4)
    profile += [(0.07, 0.046), (0.066, 0.05)] + arc(0.06, 0.054, 0.006, 0, math.pi / 2, 3)
    return lathe(profile + [(0, BASE_HEIGHT)], 36)


def tip():
    """A small plate with a rounded pin, the tip of the arms."""
    profile = [(0, 0), (0.041, 0), (0.045, 0.004), (0.045, 0.016)]
    profile += arc(0.041, 0.016, 0.004, math.pi / 4, math.pi / 2, 1)
    profile += [(0.03, 0.02), (0.026, 0.026)]
    return lathe(profile + arc(0, TIP - 0.02, 0.02, 0, math.pi / 2, 6))


# name: (solid, density in kg/m3, description)
PARTS = {
    "base": (base(), 500, "disc with a collar, 0.24 m wide, 0.06 m high"),
    "link": (tube(LINK, 3), 300, "tube of three rings, 0.1 m thick, 0.45 m long"),
    "link_short": (tube(LINK_SHORT, 2), 300, "tube of two rings, 0.1 m thick, 0.24 m long"),
    "block": (rounded_box((BLOCK,) * 3, 0.014), 700, "joint block: beveled cube of 0.12 m, centered; holds the motors"),
    "plate": (rounded_box(PLATE, 0.02), 300, "plate, 0.05 x 0.23 x 0.2 m, centered"),
    "trunk": (rounded_box(TRUNK, 0.025), 350, "long block, 0.46 x 0.18 x 0.11 m, centered"),
    "tip": (tip(), 400, "small plate with a rounded pin, 0.16 m long"),
    "leg": (capsule(LEG, LEG_TOP, LEG_BOTTOM, 28), 400, "tapered capsule, 0.22 m from joint to joint"),
    "segment": (capsule(SEGMENT, SEGMENT_RADIUS, SEGMENT_RADIUS, 32), 500, "stout capsule, 0.15 m long, 0.1 m thick"),
    "finger": (capsule(FINGER, FINGER_RADIUS, FINGER_RADIUS, 24), 900, "slim capsule, 0.09 m from joint to joint"),
}
BALL_DENSITY = 1000  # rubber: feet and eyes, plain spheres

VOLUME_CENTER_TENSOR = {name: mass_properties(part[0]) for name, part in PARTS.items()}
