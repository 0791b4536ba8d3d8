"""The five models, assembled from the parts in kit/parts.py.

In every fixed model the home pose (all joints at 0) points straight up; the quadruped's home pose is its stand.
"""

import math

from kit.parts import (BASE_HEIGHT, BLOCK, FINGER, FINGER_RADIUS, LEG, LEG_BOTTOM, LEG_TOP, LINK, LINK_SHORT, PLATE,
                       SEGMENT, SEGMENT_RADIUS, TIP, TRUNK, TUBE)
from kit.robot import Piece, Robot, box, cylinder, mesh, sphere

BEND = 1.5708  # limit of a block's joint, rad
GAP = 0.02  # a tube ends this far below the pivot, inside the block


def put_base(robot, scale=1.0):
    h = BASE_HEIGHT * scale
    hits = [cylinder(0.12 * scale, h, xyz=(0, 0, h / 2))]
    robot.link("base", [Piece("base", "graphite", scale=scale)], hits, fixed=True)


def put_tube(robot, name, part, length, color, s):
    hits = [cylinder(TUBE * s, length * s, xyz=(0, 0, length * s / 2))]
    robot.link(name, [Piece(part, color, scale=s)], hits)


def put_tip(robot, s, lift, block):
    """The last link: the pin, on a block of its own when the joint below it bends."""
    pieces = [Piece("tip", "white", xyz=(0, 0, lift), scale=s)]
    hits = [cylinder(0.045 * s, 0.02 * s, xyz=(0, 0, lift + 0.01 * s))]
    hits += [cylinder(0.022 * s, (TIP - 0.02) * s, xyz=(0, 0, lift + (TIP + 0.02) / 2 * s))]
    if block:
        pieces.insert(0, Piece("block", "white", scale=s))
        hits.insert(0, box((BLOCK * s,) * 3))
    robot.link("tip", pieces, hits)


def arm(name, about, color, part, length, stages, taper, effort, bent_tip):
    """A slender arm: in every stage a tube that twists and a block that bends it, each stage a little smaller.
    The joints count upwards from the base; odd ones twist about the arm, even ones bend about x. With `bent_tip`
    the last block carries the tip, so that the last joint bends; else the tip is one more twist."""
    robot = Robot(name, about)
    put_base(robot)
    below, height = "base", BASE_HEIGHT
    joints = 0

    def add(kind, child, z, s):
        nonlocal joints, below
        joints += 1
        twist = kind == "twist"
        # the load of a joint decreases with the size of the arm above it
        strength = effort * s**3 * (0.5 if twist else 1)
        robot.joint(f"joint_{joints}", "continuous" if twist else "revolute", below, child, (0, 0, z),
                    axis=(0, 0, 1) if twist else (1, 0, 0), limits=None if twist else (-BEND, BEND),
                    effort=round(strength, 1), velocity=4 if twist else 3, damping=round(0.4 * s**3, 2))
        below = child

    for k in range(stages):
        s = round(taper**k, 3)
        put_tube(robot, f"link_{k + 1}", part, length, color, s)
        add("twist", f"link_{k + 1}", height, s)
        if not (bent_tip and k == stages - 1):
            robot.link(f"block_{k + 1}", [Piece("block", "white", scale=s)], [box((BLOCK * s,) * 3)])
            add("bend", f"block_{k + 1}", (length + GAP) * s, s)
        height = BLOCK / 2 * s
    if bent_tip:
        put_tip(robot, s, height, block=True)
        add("bend", "tip", (length + GAP) * s, s)
    else:
        # larger than its stage, because a light tip on a heavy block is hard to simulate
        put_tip(robot, 0.85, 0, block=False)
        add("twist", "tip", height, s)
    return robot


def arm6():
    about = "An arm of six joints, 1.5 m high: three long tubes and a pointing tip."
    return arm("arm6", about, "teal", "link", LINK, 3, 0.85, 90, bent_tip=True)


def arm17():
    about = "An arm of seventeen joints, 2.2 m high: eight short tubes, each smaller than the one below."
    return arm("arm17", about, "blue", "link_short", LINK_SHORT, 8, 0.94, 140, bent_tip=False)


def quadruped():
    """Four legs of three joints. The home pose is a stand with bent knees, each foot below its hip."""
    robot = Robot("quadruped", "Four legs of three joints on a trunk: stands 0.4 m high in its home pose.")
    lean, s, foot = 0.6, 0.8, 0.032
    robot.link("trunk", [Piece("trunk", "amber")], [box(TRUNK)])
    for x, end in ((1, "front"), (-1, "back")):
        for y, side in ((1, "left"), (-1, "right")):
            leg = f"{end}_{side}"
            # sideways: positive lifts the foot outwards on both sides, so that equal values are mirrored
            robot.link(f"{leg}_hip", [Piece("block", "white", xyz=(0, y * 0.05, 0), scale=s)],
                       [box((BLOCK * s,) * 3, xyz=(0, y * 0.05, 0))])
            robot.joint(f"{leg}_hip", "revolute", "trunk", f"{leg}_hip", (x * 0.18, y * TRUNK[1] / 2, 0),
                        axis=(y, 0, 0), limits=(-0.3, 0.7), effort=40, velocity=10, damping=0.1)
            # forwards and back: positive swings the foot to the front; home leans back
            hanging = dict(rpy=(math.pi, 0, 0))
            middle = (LEG_TOP + LEG_BOTTOM) / 2
            robot.link(f"{leg}_thigh", [Piece("leg", "amber", **hanging)],
                       [cylinder(middle, LEG, xyz=(0, 0, -LEG / 2))])
            robot.joint(f"{leg}_thigh", "revolute", f"{leg}_hip", f"{leg}_thigh", (0, y * 0.05, 0), (0, lean, 0),
                        axis=(0, -1, 0), limits=(-1.0, 1.4), effort=40, velocity=10, damping=0.1)
            # the knee: positive folds the leg, -1.2 is straight
            robot.link(f"{leg}_shin", [Piece("leg", "white", **hanging)],
                       [cylinder(middle, LEG - foot, xyz=(0, 0, -(LEG - foot) / 2))])
            robot.joint(f"{leg}_knee", "revolute", f"{leg}_thigh", f"{leg}_shin", (0, 0, -LEG), (0, -2 * lean, 0),
                        axis=(0, -1, 0), limits=(-1.1, 1.3), effort=40, velocity=12, damping=0.1)
            # a rubber ball, so that contact is the same for any angle of the leg
            robot.link(f"{leg}_foot", [Piece("ball", "graphite", radius=foot)], [sphere(foot)])
            robot.joint(f"{leg}_ankle", "fixed", f"{leg}_shin", f"{leg}_foot", (0, 0, -LEG))
    return robot


def worm():
    """Twelve capsules in a row along -x behind the head; odd joints turn about z (yaw), even ones about y (pitch)."""
    robot = Robot("worm", "Twelve capsules in a row, 1.6 m long: joints turn in turn sideways and up.")
    pitch, lying, count = 0.13, (0, math.pi / 2, 0), 12
    names = ["head"] + [f"segment_{k}" for k in range(1, count - 1)] + ["tail"]
    for k, name in enumerate(names):
        # the link's frame is the joint in front of it; the head's is its middle
        middle = 0 if k == 0 else -pitch / 2
        where = dict(xyz=(middle - SEGMENT / 2, 0, 0), rpy=lying)
        pieces = [Piece("segment", "white" if k in (0, count - 1) else ("red" if k % 2 else "amber"), **where)]
        if k == 0:
            pieces += [Piece("ball", "graphite", xyz=(0.052, y, 0.031), radius=0.013) for y in (0.024, -0.024)]
        robot.link(name, pieces, [mesh("segment", **where)])
        if k:
            yaw = k % 2 == 1
            robot.joint(f"joint_{k}", "revolute", names[k - 1], name, (-pitch / 2 if k == 1 else -pitch, 0, 0),
                        axis=(0, 0, 1) if yaw else (0, 1, 0), limits=(-1, 1), effort=20, velocity=6, damping=0.1)
    return robot


def hand():
    """A right hand whose palm looks along +x, fingers up, thumb at +y. Positive angles close it."""
    robot = Robot("hand", "A right hand on a post: five fingers, a wrist that slides and turns.")
    grow, wrist = 1.25, 0.7
    put_base(robot, grow)
    put_tube(robot, "wrist", "link_short", LINK_SHORT, "graphite", wrist)
    # the tube stays in the collar of the base over the whole way
    robot.joint("lift", "prismatic", "base", "wrist", (0, 0, 0.01), limits=(0, 0.06), effort=200, velocity=0.3,
                damping=5)
    robot.link("palm", [Piece("plate", "violet", xyz=(0, 0, PLATE[2] / 2))], [box(PLATE, xyz=(0, 0, PLATE[2] / 2))])
    robot.joint("turn", "continuous", "wrist", "palm", (0, 0, LINK_SHORT * wrist), effort=20, velocity=4, damping=0.1)

    def digit(name, links, root, xyz, rpy, size, first, lower):
        """Capsules that begin where the one before ends, each nine tenths of it."""
        parent = root
        for k, part in enumerate(links):
            s, child = round(size * 0.9**k, 4), f"{name}_{part}"
            color = "white" if part == "tip" else "violet"
            robot.link(child, [Piece("finger", color, scale=s)], [mesh("finger", scale=s)])
            # the last joint of the little finger follows the middle one, as in a human hand
            follows = (f"{name}_2", 0.8) if (name, part) == ("little", "tip") else None
            robot.joint(f"{name}_{k + first}", "revolute", parent, child, xyz, rpy, axis=(0, 1, 0),
                        limits=(lower if k == 0 else 0, 1.6 if k < 2 else 1.4), effort=5, velocity=6, damping=0.02,
                        mimic=follows)
            parent, xyz, rpy = child, (0, 0, round(FINGER * s, 6)), (0, 0, 0)

    pitch, top = 2.5 * FINGER_RADIUS, PLATE[2] + 0.005
    for k, (name, size) in enumerate((("index", 0.95), ("middle", 1.0), ("ring", 0.95), ("little", 0.9))):
        digit(name, ("base", "middle", "tip"), "palm", (0, pitch * (1.5 - k), top), (0, 0, 0), size, 1, -0.3)

    # the thumb stands on a block that brings it round in front of the palm
    s = 0.5
    robot.link("thumb_root", [Piece("block", "white", scale=s)], [box((BLOCK * s,) * 3)])
    robot.joint("thumb_1", "revolute", "palm", "thumb_root", (0, PLATE[1] / 2 + BLOCK * s / 2 + 0.003, 0.05),
                axis=(0, 0, -1), limits=(-0.3, 1.6), effort=8, velocity=6, damping=0.02)
    digit("thumb", ("base", "middle", "tip"), "thumb_root", (0, 0.015, 0.02), (-0.8, 0, 0), 1.0, 2, -0.6)
    return robot


MODELS = [arm6, arm17, quadruped, worm, hand]
