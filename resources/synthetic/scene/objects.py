# SPDX-License-Identifier: Apache-2.0
"""Objects that lie on the ground, in millimetres: x along the object, z up when it lies flat, the
origin in the middle of its bounding box."""

import math

import numpy as np

from . import shapes
from .shapes import Solid

# z-axis of the solids in shapes.py -> x-axis of the object
ALONG_X = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
TUBE_TABS = [(0.5, 22.0, 7.0, 14.6, -20.0), (2.4, 40.0, 5.0, 14.2, -2.0),
             (-1.7, 9.0, 12.0, 15.0, 34.0)]  # turn about x (rad), length, width, top, middle (x)
# Half axes across (y, z), exponent of the superellipse (2: ellipse), height along the axis.
FLASK_OUTSIDE = [(15.8, 9.8, 5.0, -40.0), (17.0, 11.0, 5.0, -38.8), (17.0, 11.0, 5.0, 17.0),
                 (9.0, 9.0, 2.0, 28.0), (9.0, 9.0, 2.0, 34.5), (11.0, 11.0, 2.0, 34.5),
                 (11.0, 11.0, 2.0, 40.0)]
FLASK_INSIDE = [(7.0, 7.0, 2.0, 40.0), (7.0, 7.0, 2.0, 28.8), (15.0, 9.0, 5.0, 16.5),
                (15.0, 9.0, 5.0, -36.0)]
BROKEN_EDGE_MM = 0.04


def tube(builder, random):
    """A sample tube: grooves, a lid and a plug; tabs make every turn about its axis look
    different."""
    profile = [(0.0, -70.0), (8.0, -70.0), (8.0, -63.0), (12.6, -63.0), (12.6, -51.0),
               (10.8, -51.0), (10.8, -47.0), (12.0, -47.0), (12.0, 22.0), (10.2, 22.0),
               (10.2, 27.0), (13.4, 27.0), (13.4, 48.0), (11.0, 51.0), (9.2, 51.0), (9.2, 61.0),
               (6.2, 61.0), (6.2, 70.0), (0.0, 70.0)]
    if builder.fine:
        profile = broken(profile, BROKEN_EDGE_MM)
    builder.add("tube", builder.lathe(profile).placed(ALONG_X, [0.0] * 3))
    for turn, length, width, top, middle in TUBE_TABS:
        _on_side(builder, "sleeve", shapes.box(length, width, 8.0, top, middle), turn)
    if not builder.fine:
        return []
    for _ in range(3):
        x, turn = random.uniform(-40.0, 15.0), random.uniform(0.6, 2.2)
        head = shapes.lathe([(0.9, 11.6), (0.9, 12.3), (0.0, 12.3)], 20).moved(x)
        _on_side(builder, "steel", head, turn)
    for x in (-35.0, 40.0):
        band = [(12.0 if x < 0 else 13.4, x - 0.4), (12.05 if x < 0 else 13.45, x - 0.35),
                (12.05 if x < 0 else 13.45, x + 0.35), (12.0 if x < 0 else 13.4, x + 0.4)]
        builder.add("black", builder.lathe(band).placed(ALONG_X, [0.0] * 3))
    return []


def flask(builder, _, material):
    """A flat vial with a shoulder, a neck and a lip: one closed surface, inside and outside."""
    count = 288 if builder.fine else 96
    solid = loft([*FLASK_OUTSIDE, *FLASK_INSIDE], count)
    builder.add(material, solid.placed(ALONG_X, [0.0] * 3))
    return []


def _on_side(builder, material, solid, turn):
    """A solid made upright on the x-axis, turned about it."""
    c, s = math.cos(turn), math.sin(turn)
    builder.add(material, solid.placed([[1, 0, 0], [0, c, -s], [0, s, c]], [0.0] * 3))


def broken(profile, width):
    """A profile whose corners are cut at `width` from each."""
    points = np.array(profile, dtype=np.float64)
    made = [points[0]]
    for before, here, after in zip(points, points[1:], points[2:]):
        for other in (before, after):
            step = other - here
            made.append(here + step * min(0.5, width / np.linalg.norm(step)))
    return [tuple(p) for p in [*made, points[-1]]]


def superellipse(a, b, exponent, count):
    """An outline |y/a|^n + |z/b|^n = 1, counter-clockwise, at even angles."""
    angle = 2.0 * math.pi * np.arange(count) / count
    c, s = np.cos(angle), np.sin(angle)
    radius = (np.abs(c / a) ** exponent + np.abs(s / b) ** exponent) ** (-1.0 / exponent)
    return np.column_stack([radius * c, radius * s])


def loft(rings, count):
    """Joins outlines along z, closed by fans at both ends; outside to the right of the path."""
    widened = 1.0 + (math.pi / count) ** 2 / 6.0  # as shapes.circle
    vertices = [np.column_stack([superellipse(a * widened, b * widened, n, count),
                                 np.full(count, z)]) for a, b, n, z in rings]
    here, there = np.arange(count), np.roll(np.arange(count), -1)
    first, last = count * len(rings), count * len(rings) + 1
    triangles = [np.column_stack([np.full(count, first), there, here])]
    for i in range(len(rings) - 1):
        a, b = i * count, (i + 1) * count
        triangles += [np.column_stack([a + here, a + there, b + there]),
                      np.column_stack([a + here, b + there, b + here])]
    end = count * (len(rings) - 1)
    triangles.append(np.column_stack([end + here, end + there, np.full(count, last)]))
    ends = np.array([[0.0, 0.0, rings[0][3]], [0.0, 0.0, rings[-1][3]]])
    return Solid(np.vstack([*vertices, ends]), np.vstack(triangles))
