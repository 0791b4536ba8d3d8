"""Robots assembled from parts: links with computed masses and tensors, joints, and the URDF text.

Frames, signs and units follow URDF: meters, radians, rpy about fixed axes x, y, z.
"""

import math

from kit.parts import BALL_DENSITY, PARTS, VOLUME_CENTER_TENSOR

COLORS = {
    "graphite": (0.14, 0.14, 0.15),
    "white": (0.92, 0.90, 0.87),
    "teal": (0.11, 0.56, 0.47),
    "blue": (0.10, 0.27, 0.72),
    "amber": (0.93, 0.66, 0.16),
    "red": (0.85, 0.22, 0.18),
    "violet": (0.50, 0.18, 0.72),
}


def number(value):
    """Six significant digits, no negative zero."""
    return f"{value + 0.0:.6g}" if abs(value) > 1e-12 else "0"


def triple(values):
    return " ".join(number(v) for v in values)


def rotation(rpy):
    """The matrix of roll, pitch, yaw: Rz(yaw) Ry(pitch) Rx(roll)."""
    (sr, sp, sy), (cr, cp, cy) = [math.sin(a) for a in rpy], [math.cos(a) for a in rpy]
    return [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]


def turn(m, v):
    return [sum(m[i][k] * v[k] for k in range(3)) for i in range(3)]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def sphere_text(radius):
    return f'<sphere radius="{number(radius)}"/>'


def mesh_text(part, scale):
    scaled = "" if scale == 1 else f' scale="{triple((scale,) * 3)}"'
    return f'<mesh filename="meshes/{part}.stl"{scaled}/>'


class Piece:
    """A visual of a link: a part, scaled uniformly, or a ball."""

    def __init__(self, part, color, xyz=(0, 0, 0), rpy=(0, 0, 0), scale=1.0, radius=None):
        self.part, self.color, self.xyz, self.rpy, self.scale, self.radius = part, color, xyz, rpy, scale, radius

    def geometry(self):
        return sphere_text(self.radius) if self.part == "ball" else mesh_text(self.part, self.scale)

    def inertia(self):
        """Mass, center of mass and tensor about it, in the link's frame."""
        if self.part == "ball":
            mass = BALL_DENSITY * 4 / 3 * math.pi * self.radius**3
            moment = 0.4 * mass * self.radius**2
            return mass, list(self.xyz), [[moment if i == j else 0 for j in range(3)] for i in range(3)]
        volume, center, tensor = VOLUME_CENTER_TENSOR[self.part]
        density, s, m = PARTS[self.part][1], self.scale, rotation(self.rpy)
        placed = [x + s * c for x, c in zip(self.xyz, turn(m, center))]
        turned = product(product(m, tensor), [list(row) for row in zip(*m)])
        return density * volume * s**3, placed, [[density * s**5 * x for x in row] for row in turned]

    def points(self, pose):
        """World positions of the corners for a pose of the link; for a ball, its extreme points along the world's axes."""
        m, p = pose
        place = lambda q: [a + b for a, b in zip(p, turn(m, q))]
        if self.part == "ball":
            middle, r = place(self.xyz), self.radius
            return [[x + r * d * (i == k) for i, x in enumerate(middle)] for k in range(3) for d in (-1, 1)]
        own, corners = rotation(self.rpy), {q for tri in PARTS[self.part][0] for q in tri}
        return [place([x + self.scale * c for x, c in zip(self.xyz, turn(own, q))]) for q in sorted(corners)]


class Hit:
    """A collision shape of a link: URDF text of its geometry, and its pose."""

    def __init__(self, geometry, xyz=(0, 0, 0), rpy=(0, 0, 0)):
        self.text, self.xyz, self.rpy = geometry, xyz, rpy

    def geometry(self):
        return self.text


def box(size, **where):
    return Hit(f'<box size="{triple(size)}"/>', **where)


def cylinder(radius, length, **where):
    return Hit(f'<cylinder radius="{number(radius)}" length="{number(length)}"/>', **where)


def sphere(radius, **where):
    return Hit(sphere_text(radius), **where)


def mesh(part, scale=1, **where):
    return Hit(mesh_text(part, scale), **where)


class Link:
    """A link with visuals and collision shapes; its inertia is the sum over the visuals. `fixed`: static, no mass."""

    def __init__(self, name, pieces, hits, fixed=False):
        self.name, self.pieces, self.hits = name, pieces, hits
        self.mass, self.center, self.tensor = (0, [0.0] * 3, None) if fixed else self.sum_up()

    def sum_up(self):
        """Mass, center and tensor of all pieces as one rigid body, by the parallel axis theorem."""
        all_of = [piece.inertia() for piece in self.pieces]
        mass = sum(m for m, _, _ in all_of)
        center = [sum(m * c[i] for m, c, _ in all_of) / mass for i in range(3)]
        tensor = [[0.0] * 3 for _ in range(3)]
        for m, c, own in all_of:
            d = [c[i] - center[i] for i in range(3)]
            far = sum(x * x for x in d)
            for i in range(3):
                for j in range(3):
                    tensor[i][j] += own[i][j] + m * ((far if i == j else 0) - d[i] * d[j])
        return mass, center, tensor

    def xml(self):
        lines = [f'  <link name="{self.name}">']
        if self.mass:
            t = self.tensor
            names = (("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2))
            # products of inertia that are only rounding errors are set to zero
            least = 1e-6 * max(t[i][i] for i in range(3))
            moments = [(n, t[i][j] if abs(t[i][j]) > least else 0) for n, i, j in names]
            center = [c if abs(c) > 1e-6 else 0 for c in self.center]
            lines += ["    <inertial>", f'      <origin xyz="{triple(center)}"/>']
            lines += [f'      <mass value="{number(self.mass)}"/>']
            lines += ["      <inertia " + " ".join(f'{n}="{number(x)}"' for n, x in moments) + "/>", "    </inertial>"]
        for tag, items in (("visual", self.pieces), ("collision", self.hits)):
            for item in items:
                rpy = f' rpy="{triple(item.rpy)}"' if any(item.rpy) else ""
                lines += [f"    <{tag}>"]
                lines += [f'      <origin xyz="{triple(item.xyz)}"{rpy}/>'] if any(item.xyz) or rpy else []
                lines += [f"      <geometry>{item.geometry()}</geometry>"]
                lines += [f'      <material name="{item.color}"/>'] if tag == "visual" else []
                lines += [f"    </{tag}>"]
        return lines + ["  </link>"]


class Joint:
    """A URDF joint; effort in N·m or N, velocity in rad/s or m/s; without limits it is free."""

    def __init__(self, name, kind, parent, child, xyz, rpy=(0, 0, 0), axis=(0, 0, 1), limits=None, effort=0,
                 velocity=0, damping=0, mimic=None):
        self.name, self.kind, self.parent, self.child, self.xyz, self.rpy = name, kind, parent, child, xyz, rpy
        self.axis, self.limits, self.effort, self.velocity = axis, limits, effort, velocity
        self.damping, self.mimic = damping, mimic

    def xml(self):
        rpy = f' rpy="{triple(self.rpy)}"' if any(self.rpy) else ""
        lines = [f'  <joint name="{self.name}" type="{self.kind}">']
        lines += [f'    <parent link="{self.parent}"/>', f'    <child link="{self.child}"/>']
        lines += [f'    <origin xyz="{triple(self.xyz)}"{rpy}/>']
        if self.kind != "fixed":
            ends = "" if self.limits is None else 'lower="{}" upper="{}" '.format(*map(number, self.limits))
            lines += [f'    <axis xyz="{triple(self.axis)}"/>']
            lines += [f'    <limit {ends}effort="{number(self.effort)}" velocity="{number(self.velocity)}"/>']
            lines += [f'    <dynamics damping="{number(self.damping)}"/>'] if self.damping else []
        if self.mimic:
            lines += [f'    <mimic joint="{self.mimic[0]}" multiplier="{number(self.mimic[1])}" offset="0"/>']
        return lines + ["  </joint>"]


class Robot:
    """Links and joints, the root first, every child after its parent."""

    def __init__(self, name, about):
        self.name, self.about, self.links, self.joints = name, about, [], []

    def link(self, name, pieces, hits, fixed=False):
        self.links.append(Link(name, pieces, hits, fixed))

    def joint(self, *args, **kwargs):
        self.joints.append(Joint(*args, **kwargs))

    def xml(self):
        used = {piece.color for link in self.links for piece in link.pieces}
        lines = ['<?xml version="1.0"?>', f"<!-- {self.about} Made by make_models.py: change it there. -->"]
        lines += [f'<robot name="{self.name}">']
        for color in (c for c in COLORS if c in used):
            lines += [f'  <material name="{color}"><color rgba="{triple(COLORS[color])} 1"/></material>']
        for link in self.links:
            lines += link.xml()
        for joint in self.joints:
            lines += joint.xml()
        return "\n".join(lines + ["</robot>", ""])
