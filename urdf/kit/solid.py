"""Triangle meshes: surfaces of revolution and rounded boxes, their mass properties, and binary STL.

A solid is a list of triangles, each three (x, y, z) tuples in meters, counter-clockwise seen from outside.
"""

import math
import struct

GRID = 6  # decimals of a coordinate: rounding to 1 µm hides differences between platforms' sine functions


def snap(point):
    """Rounds a point to the micrometer grid and to single precision, without negative zeros."""
    return tuple(struct.unpack("<f", struct.pack("<f", round(c, GRID) + 0.0))[0] for c in point)


def closed(triangles):
    """Rounds the triangles to the grid and removes degenerate ones; asserts that the solid is watertight."""
    solid = [t for t in (tuple(snap(p) for p in tri) for tri in triangles) if len(set(t)) == 3]
    edges = set()
    for a, b, c in solid:
        for edge in ((a, b), (b, c), (c, a)):
            assert edge not in edges, f"edge {edge} is used twice in one direction"
            edges.add(edge)
    assert all((b, a) in edges for a, b in edges), "the solid has a hole"
    return solid


def lathe(profile, sides=32):
    """Revolves a profile of (radius, z) about z. The profile starts and ends on the axis and runs upwards."""
    assert profile[0][0] == 0 and profile[-1][0] == 0
    angles = [2 * math.pi * k / sides for k in range(sides)]
    ring = lambda r, z: [(r * math.cos(a), r * math.sin(a), z) for a in angles]
    rings = [ring(r, z) for r, z in profile]
    triangles = []
    for low, high in zip(rings, rings[1:]):
        for k in range(sides):
            n = (k + 1) % sides
            triangles.append((low[k], low[n], high[n]))
            triangles.append((low[k], high[n], high[k]))
    return closed(triangles)


def rounded_box(size, radius, steps=3):
    """A box centered on the origin with rounded edges and corners: each face is a grid, and its border bends by 45
    degrees to join its neighbor; the points are those of a sphere, offset to the corners of the inner box."""
    inner = [s / 2 - radius for s in size]
    bend = [math.pi / 4 * k / steps for k in range(steps + 1)]
    # (tangent, side): the flat middle of the face is between the two zeros
    marks = [(-math.tan(a), -1) for a in reversed(bend)] + [(math.tan(a), 1) for a in bend]
    triangles = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (-1, 1):

            def at(mu, mv):
                direction = [0.0, 0.0, 0.0]
                direction[axis], direction[u], direction[v] = side, mu[0], mv[0]
                length = math.sqrt(sum(d * d for d in direction))
                point = [radius * d / length for d in direction]
                point[axis] += side * inner[axis]
                point[u] += mu[1] * inner[u]
                point[v] += mv[1] * inner[v]
                return tuple(point)

            for a, b in zip(marks, marks[1:]):
                for c, d in zip(marks, marks[1:]):
                    quad = [at(a, c), at(b, c), at(b, d), at(a, d)]
                    if side < 0:
                        quad.reverse()
                    triangles += [(quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])]
    return closed(triangles)


def arc(center_r, center_z, radius, start, end, steps):
    """Points of a profile on a circle, from angle `start` to `end` (radians, 0 outwards, pi/2 up)."""
    angles = [start + (end - start) * k / steps for k in range(steps + 1)]
    points = [(center_r + radius * math.cos(a), center_z + radius * math.sin(a)) for a in angles]
    return [(0 if abs(r) < 1e-9 else r, z) for r, z in points]


def mass_properties(triangles):
    """Volume, center and the tensor about the center for density 1, exact for the polyhedron: each triangle spans a
    tetrahedron with the origin; the integrals of 1, x and x*y over it are polynomials of its corners."""
    volume, first, second = 0.0, [0.0] * 3, [[0.0] * 3 for _ in range(3)]
    for a, b, c in triangles:
        det = (
            a[0] * (b[1] * c[2] - b[2] * c[1])
            - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
        )
        volume += det / 6
        total = [a[i] + b[i] + c[i] for i in range(3)]
        for i in range(3):
            first[i] += det / 24 * total[i]
            for j in range(3):
                second[i][j] += det / 120 * (total[i] * total[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j])
    center = [f / volume for f in first]
    spread = [[second[i][j] - volume * center[i] * center[j] for j in range(3)] for i in range(3)]
    trace = sum(spread[i][i] for i in range(3))
    tensor = [[(trace if i == j else 0) - spread[i][j] for j in range(3)] for i in range(3)]
    return volume, center, tensor


def stl_bytes(triangles):
    """Binary STL: 80 bytes of header, a count, then for each triangle its normal and corners."""
    out = [b"\0" * 80, struct.pack("<I", len(triangles))]
    for a, b, c in triangles:
        u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        length = math.sqrt(sum(x * x for x in n))
        normal = [round(x / length, 4) + 0.0 for x in n]
        out.append(struct.pack("<12fH", *normal, *a, *b, *c, 0))
    return b"".join(out)
