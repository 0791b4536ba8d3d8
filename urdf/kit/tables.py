"""Generates the tables of docs/reference/models.md from the models."""

import math

from kit.parts import PARTS, VOLUME_CENTER_TENSOR
from kit.robot import product, rotation, turn


def home_poses(robot):
    """Rotation and position of every link with all joints at 0: forward kinematics."""
    poses = {robot.links[0].name: (rotation((0, 0, 0)), [0.0, 0.0, 0.0])}
    for joint in robot.joints:
        m, p = poses[joint.parent]
        poses[joint.child] = (product(m, rotation(joint.rpy)), [a + b for a, b in zip(p, turn(m, joint.xyz))])
    return poses


def extent(robot):
    """Minimum and maximum corner of the bounding box of all visuals, in the home pose."""
    poses = home_poses(robot)
    points = [q for link in robot.links for piece in link.pieces for q in piece.points(poses[link.name])]
    return [min(q[i] for q in points) for i in range(3)], [max(q[i] for q in points) for i in range(3)]


def reach(robot):
    """Upper bound of the distance from the first joint (of a free body: from the root's frame) to any point: the sum
    of the distances between joints plus the distance of the last link's farthest corner."""
    into, root = {joint.child: joint for joint in robot.joints}, robot.links[0]
    still, best = (rotation((0, 0, 0)), (0, 0, 0)), 0.0
    for link in robot.links if root.mass else robot.links[1:]:
        far = max(math.dist((0, 0, 0), q) for piece in link.pieces for q in piece.points(still))
        name = link.name
        while name in into and (root.mass or into[name].parent != root.name):
            far += math.dist((0, 0, 0), into[name].xyz)
            name = into[name].parent
        best = max(best, far)
    return best


def part_table():
    lines = ["| part | description | density kg/m³ | mass at scale 1, kg | triangles |", "|---|---|---:|---:|---:|"]
    for name, (solid, density, about) in PARTS.items():
        mass = density * VOLUME_CENTER_TENSOR[name][0]
        lines.append(f"| `{name}` | {about} | {density} | {mass:.3f} | {len(solid)} |")
    return lines


def summary(robot):
    low, high = extent(robot)
    size = " × ".join(f"{b - a:.2f}" for a, b in zip(low, high))
    moving = [joint for joint in robot.joints if joint.kind != "fixed"]
    root = robot.links[0]
    feet = f"fixed to the world by `{root.name}`" if not root.mass else f"free; `{root.name}` floats"
    lines = ["| | |", "|---|---|", f"| links, moving joints | {len(robot.links)}, {len(moving)} |"]
    lines += [f"| root | {feet} |"]
    lines += [f"| mass | {sum(link.mass for link in robot.links):.2f} kg |"]
    lines += [f"| size at home, x × y × z | {size} m |"]
    if root.mass:
        lines += [f"| lowest point at home | {-low[2]:.3f} m below the root's frame |"]
    return lines + [f"| reach | {reach(robot):.2f} m from the {'root' if root.mass else 'first joint'} |"]


def joint_table(robot):
    links = {link.name: link for link in robot.links}
    lines = ["| joint | type | axis | from → to | limits | effort | velocity | mass of `to`, kg |"]
    lines += ["|---|---|---|---|---|---:|---:|---:|"]
    for j in robot.joints:
        axis = "" if j.kind == "fixed" else " ".join(f"{a:g}" for a in j.axis)
        ends = "free" if j.limits is None else f"{j.limits[0]:g} … {j.limits[1]:g}"
        ends = "" if j.kind == "fixed" else ends
        ends += f", follows `{j.mimic[0]}` × {j.mimic[1]:g}" if j.mimic else ""
        force, speed = ("", "") if j.kind == "fixed" else (f"{j.effort:g}", f"{j.velocity:g}")
        lines.append(f"| `{j.name}` | {j.kind} | {axis} | `{j.parent}` → `{j.child}` | {ends} | {force} | {speed} "
                     f"| {links[j.child].mass:.3f} |")
    return lines


def fill(text, robots):
    """Returns the page with the lines between each `<!-- made: x -->` and `<!-- end -->` replaced by generated tables."""
    makers = {"parts": part_table}
    for robot in robots:
        makers[robot.name] = lambda robot=robot: summary(robot) + [""] + joint_table(robot)
    out, skipping = [], False
    for line in text.split("\n"):
        if line.startswith("<!-- end -->"):
            skipping = False
        if not skipping:
            out.append(line)
        if line.startswith("<!-- made: "):
            out += makers[line.removeprefix("<!-- made: ").removesuffix(" -->")]()
            skipping = True
    return "\n".join(out)
