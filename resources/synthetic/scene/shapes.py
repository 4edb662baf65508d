# SPDX-License-Identifier: Apache-2.0
"""Solids from numbers: triangle meshes in millimetres, as numpy arrays.

Round things are polygons whose mean radius is the true one, so that a coarse circle lies neither
inside nor outside of a fine one on average.
"""

import math

import numpy as np
from mathutils import Vector
from mathutils.geometry import delaunay_2d_cdt


class Solid:
    """Vertices (n x 3, mm) and triangles (m x 3), counter-clockwise seen from outside."""

    def __init__(self, vertices=(), triangles=()):
        self.vertices = np.asarray(vertices, dtype=np.float64).reshape(-1, 3)
        self.triangles = np.asarray(triangles, dtype=np.int64).reshape(-1, 3)

    def add(self, other):
        """Appends another solid; they may overlap."""
        self.triangles = np.vstack([self.triangles, other.triangles + len(self.vertices)])
        self.vertices = np.vstack([self.vertices, other.vertices])
        return self

    def moved(self, x=0.0, y=0.0, z=0.0, turn_rad=0.0):
        """Turned about z, then moved."""
        c, s = math.cos(turn_rad), math.sin(turn_rad)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        return Solid(self.vertices @ turn.T + [x, y, z], self.triangles)

    def placed(self, rotation, translation):
        """Under a 3x3 rotation and a translation."""
        return Solid(self.vertices @ np.asarray(rotation).T + translation, self.triangles)


def circle(radius, segments, x=0.0, y=0.0, start_rad=0.0):
    """A polygon of the given mean radius, counter-clockwise."""
    vertex_radius = radius * (1.0 + (math.pi / segments) ** 2 / 6.0)
    angles = start_rad + 2.0 * math.pi * np.arange(segments) / segments
    return np.stack([x + vertex_radius * np.cos(angles), y + vertex_radius * np.sin(angles)], 1)


def segments_for(radius, sagitta):
    """How many sides a circle needs so that no chord is farther than `sagitta` off it."""
    needed = math.pi / math.acos(max(0.0, 1.0 - min(1.0, sagitta / radius)))
    return int(min(360, max(16, 4 * math.ceil(needed / 4))))


def arc(inner, outer, from_rad, to_rad, segments):
    """The outline of a sector of a ring of the given mean radii, counter-clockwise."""
    angles = np.linspace(from_rad, to_rad, segments)
    widened = 1.0 + (0.5 * (angles[1] - angles[0])) ** 2 / 6.0
    inner, outer = inner * widened, outer * widened
    out = np.stack([outer * np.cos(angles), outer * np.sin(angles)], 1)
    back = np.stack([inner * np.cos(angles[::-1]), inner * np.sin(angles[::-1])], 1)
    return np.vstack([out, back])


def rectangle(width, height, x=0.0, y=0.0, turn_rad=0.0):
    """An outline, counter-clockwise."""
    corners = 0.5 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * [width, height]
    c, s = math.cos(turn_rad), math.sin(turn_rad)
    return corners @ np.array([[c, s], [-s, c]]) + [x, y]


def _inside(points, outline):
    """Which points lie inside a polygon (even-odd rule)."""
    x, y = points[:, 0], points[:, 1]
    odd = np.zeros(len(points), dtype=bool)
    for (x0, y0), (x1, y1) in zip(outline, np.roll(outline, -1, axis=0)):
        crosses = (y0 > y) != (y1 > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            odd ^= crosses & (x < (x1 - x0) * (y - y0) / (y1 - y0) + x0)
    return odd


def _fill(outlines):
    """Triangulates what lies inside of the first outline and outside of the others."""
    points, edges = [], []
    for outline in outlines:
        first, count = len(points), len(outline)
        points += [Vector((float(x), float(y))) for x, y in outline]
        edges += [(first + i, first + (i + 1) % count) for i in range(count)]
    found, _, faces, _, _, _ = delaunay_2d_cdt(points, edges, [], 0, 1e-6)
    flat = np.array([[p.x, p.y] for p in found])
    faces = np.array([list(f) for f in faces])
    middles = flat[faces].mean(axis=1)
    keep = _inside(middles, outlines[0])
    for hole in outlines[1:]:
        keep &= ~_inside(middles, hole)
    return flat, faces[keep]


def prism(outline, bottom, top, holes=()):
    """An outline with holes, between two heights."""
    flat, faces = _fill([outline, *holes])
    count = len(flat)
    low = np.column_stack([flat, np.full(count, bottom)])
    high = np.column_stack([flat, np.full(count, top)])
    made = Solid(np.vstack([high, low]), np.vstack([faces, faces[:, ::-1] + count]))
    for ring, outward in [(outline, True), *((hole, False) for hole in holes)]:
        made.add(_wall(ring if outward else ring[::-1], bottom, top))
    return made


def _wall(ring, bottom, top):
    count = len(ring)
    low = np.column_stack([ring, np.full(count, bottom)])
    high = np.column_stack([ring, np.full(count, top)])
    here, there = np.arange(count), np.roll(np.arange(count), -1)
    return Solid(np.vstack([low, high]),
                 np.vstack([np.column_stack([here, there, there + count]),
                            np.column_stack([here, there + count, here + count])]))


def lathe(profile, segments):
    """Turns a profile of (radius, height) about z; outside lies to the right of its direction
    when it is drawn with the radius to the right and the height upwards."""
    rings = []
    for radius, height in profile:
        ring = circle(max(radius, 1e-6), segments)
        rings.append(np.column_stack([ring, np.full(segments, height)]))
    here, there = np.arange(segments), np.roll(np.arange(segments), -1)
    triangles = []
    for i, ((r0, _), (r1, _)) in enumerate(zip(profile, profile[1:])):
        a, b = i * segments, (i + 1) * segments
        if r0 > 0.0:
            triangles.append(np.column_stack([a + here, a + there, b + there]))
        if r1 > 0.0:
            triangles.append(np.column_stack([a + here, b + there, b + here]))
    return Solid(np.vstack(rings), np.vstack(triangles))


def box(width, depth, bottom, top, x=0.0, y=0.0, turn_rad=0.0):
    """A block upright on a rectangle."""
    return prism(rectangle(width, depth, x, y, turn_rad), bottom, top)


def sweep(path, radius, sides=20):
    """A round cable along points (n x 3)."""
    path = np.asarray(path, dtype=np.float64)
    ahead = np.gradient(path, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    side = np.cross(ahead, [0.31, 0.17, 0.93])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    across = np.cross(ahead, side)
    ring = circle(radius, sides)
    vertices = (path[:, None, :] + ring[None, :, 0:1] * side[:, None, :]
                + ring[None, :, 1:2] * across[:, None, :]).reshape(-1, 3)
    here, there = np.arange(sides), np.roll(np.arange(sides), -1)
    triangles = []
    for i in range(len(path) - 1):
        a, b = i * sides, (i + 1) * sides
        triangles += [np.column_stack([a + here, a + there, b + there]),
                      np.column_stack([a + here, b + there, b + here])]
    return Solid(vertices, np.vstack(triangles))


def spline(points, count=40):
    """A smooth path (Catmull-Rom) through points (n x 3)."""
    p = np.asarray(points, dtype=np.float64)
    p = np.vstack([2 * p[0] - p[1], p, 2 * p[-1] - p[-2]])
    made = []
    for i in range(1, len(p) - 2):
        t = np.linspace(0.0, 1.0, count, endpoint=False)[:, None]
        made.append(0.5 * (2 * p[i] + (p[i + 1] - p[i - 1]) * t
                           + (2 * p[i - 1] - 5 * p[i] + 4 * p[i + 1] - p[i + 2]) * t ** 2
                           + (3 * p[i] - p[i - 1] - 3 * p[i + 1] + p[i + 2]) * t ** 3))
    return np.vstack([*made, p[-2:-1]])
