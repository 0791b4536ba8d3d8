#!/usr/bin/env python3
"""Writes dancer.bvh: eight seconds of a dance that begins again without a jump. Y is up, lengths are in cm."""

import math
import pathlib

SECONDS = 8
RATE = 25
# name, parent, offset from the parent, turns about z, x and y in degrees at a time (in turns of the dance)
JOINTS = [
    ("hips", None, (0, 0, 0)),
    ("spine", "hips", (0, 12, 0)),
    ("chest", "spine", (0, 22, 0)),
    ("neck", "chest", (0, 20, 0)),
    ("head", "neck", (0, 12, 2)),
    ("head_top", "head", (0, 14, 0)),
    ("left_upper_arm", "chest", (18, 14, 0)),
    ("left_forearm", "left_upper_arm", (28, 0, 0)),
    ("left_hand", "left_forearm", (25, 0, 0)),
    ("right_upper_arm", "chest", (-18, 14, 0)),
    ("right_forearm", "right_upper_arm", (-28, 0, 0)),
    ("right_hand", "right_forearm", (-25, 0, 0)),
    ("left_thigh", "hips", (10, -4, 0)),
    ("left_shin", "left_thigh", (0, -42, 0)),
    ("left_foot", "left_shin", (0, -40, 0)),
    ("left_toes", "left_foot", (0, -6, 14)),
    ("right_thigh", "hips", (-10, -4, 0)),
    ("right_shin", "right_thigh", (0, -42, 0)),
    ("right_foot", "right_shin", (0, -40, 0)),
    ("right_toes", "right_foot", (0, -6, 14)),
]


def wave(time, cycles, shift=0.0):
    return math.sin(2 * math.pi * (cycles * time + shift))


def turns(name, time):
    """The turns of a joint about z, x and y, degrees; all are periodic in `time`, 0 .. 1."""
    side = 1 if name.startswith("left") else -1
    shift = 0 if side == 1 else 0.5
    lift = 0.5 + 0.5 * wave(time, 4, shift)  # a step of this leg
    if name == "hips":
        return 4 * wave(time, 4), 0, 35 * wave(time, 1)
    if name == "spine":
        return -5 * wave(time, 4), 6 * wave(time, 2), 10 * wave(time, 2, 0.1)
    if name == "chest":
        return 8 * wave(time, 2), -8 + 8 * wave(time, 1), 18 * wave(time, 2, 0.2)
    if name == "neck":
        return -6 * wave(time, 2), 6 * wave(time, 2, 0.3), -20 * wave(time, 1, 0.1)
    if name.endswith("upper_arm"):
        return side * (-20 + 55 * wave(time, 2, shift / 2)), 20 * wave(time, 1), side * (-25 + 30 * wave(time, 1, shift))
    if name.endswith("forearm"):
        return side * 12 * wave(time, 4, shift), 0, side * (-45 + 40 * wave(time, 2, 0.25 + shift))
    if name.endswith("thigh"):
        return side * 6, -32 * lift * lift, side * 8
    if name.endswith("shin"):
        return 0, 8 + 58 * lift * lift, 0
    if name.endswith("foot"):
        return 0, -4 - 20 * lift * lift, 0
    return 0, 0, 0


def multiply(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def rotation(angles):
    z, x, y = (math.radians(a) for a in angles)
    turn_z = [[math.cos(z), -math.sin(z), 0], [math.sin(z), math.cos(z), 0], [0, 0, 1]]
    turn_x = [[1, 0, 0], [0, math.cos(x), -math.sin(x)], [0, math.sin(x), math.cos(x)]]
    turn_y = [[math.cos(y), 0, math.sin(y)], [0, 1, 0], [-math.sin(y), 0, math.cos(y)]]
    return multiply(multiply(turn_z, turn_x), turn_y)


def lowest(time):
    """Height of the lowest joint, with the hips at 0."""
    poses = {}
    for name, parent, offset in JOINTS:
        place, frame = poses[parent] if parent else ((0, 0, 0), [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
        moved = tuple(place[i] + sum(frame[i][k] * offset[k] for k in range(3)) for i in range(3))
        poses[name] = (moved, multiply(frame, rotation(turns(name, time))))
    return min(place[1] for place, _ in poses.values())


def hierarchy(name, indent):
    children = [child for child, parent, _ in JOINTS if parent == name]
    _, parent, offset = next(joint for joint in JOINTS if joint[0] == name)
    space = "  " * indent
    lines = [f"{space}{'JOINT' if parent else 'ROOT'} {name}", space + "{", f"{space}  OFFSET {' '.join(map(str, offset))}"]
    position = "" if parent else "Xposition Yposition Zposition "
    lines.append(f"{space}  CHANNELS {3 if parent else 6} {position}Zrotation Xrotation Yrotation")
    for child in children:
        lines += hierarchy(child, indent + 1)
    if not children:
        lines += [f"{space}  End Site", space + "  {", f"{space}    OFFSET 0 2 0", space + "  }"]
    return lines + [space + "}"]


def main():
    order = []

    def visit(name):
        order.append(name)
        for child, parent, _ in JOINTS:
            if parent == name:
                visit(child)

    visit("hips")
    lines = ["HIERARCHY", *hierarchy("hips", 0), "MOTION"]
    frames = SECONDS * RATE + 1
    lines += [f"Frames: {frames}", f"Frame Time: {1 / RATE:.6f}"]
    for frame in range(frames):
        time = frame / (frames - 1)
        values = [40 * wave(time, 1), 3 - lowest(time), 25 * wave(time, 2)]
        for name in order:
            values += turns(name, time)
        lines.append(" ".join(f"{round(value, 2) + 0:g}" for value in values))
    pathlib.Path(__file__).with_name("dancer.bvh").write_text("\n".join(lines) + "\n", encoding="ascii")


if __name__ == "__main__":
    main()
