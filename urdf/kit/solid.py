"""Solids of triangles: a lathe and a rounded box, their mass properties, and binary STL.

A solid is a list of triangles, each three (x, y, z) tuples in metres, counter-clockwise seen from outside.
"""

import math
import struct

GRID = 6  # decimals kept of a coordinate: a micrometre hides the last bit of any platform's sine


def snap(point):
    """The point on the micrometre grid, as a single-precision file will hold it; no negative zeros."""
    return tuple(struct.unpack("<f", struct.pack("<f", round(c, GRID) + 0.0))[0] for c in point)


def closed(triangles):
    """The triangles on the grid, without those that have shrunk to nothing; refuses a solid that leaks."""
    solid = [t for t in (tuple(snap(p) for p in tri) for tri in triangles) if len(set(t)) == 3]
    edges = set()
    for a, b, c in solid:
        for edge in ((a, b), (b, c), (c, a)):
            assert edge not in edges, f"edge {edge} is used twice in one direction"
            edges.add(edge)
    assert all((b, a) in edges for a, b in edges), "the solid has a hole"
    return solid


def lathe(profile, sides=32):
    """Turns a profile of (radius, z) about z. It starts and ends on the axis and runs upwards."""
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
    """A box centred on the origin whose edges and corners are rounded: each face is a grid whose border bends
    over by 45 degrees to meet its neighbour; the corner's sphere is pulled apart by the inner box."""
    inner = [s / 2 - radius for s in size]
    bend = [math.pi / 4 * k / steps for k in range(steps + 1)]
    # (tangent, side): the flat middle is the stretch between the two zeros
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
    """Volume, centre and the tensor about the centre for density 1, exact for the polyhedron: each triangle
    spans a tetrahedron with the origin, whose integrals of 1, x and x*y are polynomials of its corners."""
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
