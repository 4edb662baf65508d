# SPDX-License-Identifier: Apache-2.0
"""Objects that lie or stand on the ground, in millimetres, z up. The sample tube and the vial lie
along x. The origin is in or near the middle of the bounding box (plan.STATIONS: `centre_m`)."""

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


def mug(builder, _):
    """A mug with a handle; `fine` has a printed band."""
    wall = [(0.0, -45.0), (36.0, -45.0), (40.0, -41.0), (40.0, 45.0), (36.5, 45.0), (36.5, -38.0),
            (0.0, -38.0)]
    builder.add("ceramic", builder.lathe(wall))
    turns = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 41 if builder.fine else 17)
    path = np.column_stack([38.0 + 24.0 * np.cos(turns), np.zeros(len(turns)), 26.0 * np.sin(turns)])
    builder.add("ceramic", shapes.sweep(path, 5.5, 40 if builder.fine else 20))
    if builder.fine:
        for low, high in ((-20.0, -14.0), (4.0, 24.0)):
            builder.add("black", _printed_arc(40.06, 0.8, 5.4, low, high))
    return []


def bowl(builder, _):
    """A round bowl: every turn about z looks the same."""
    turns = np.linspace(0.0, 1.32, 30 if builder.fine else 14)
    outside = [(28.0 + 50.0 * math.sin(t), -28.0 + 60.0 * (1.0 - math.cos(t))) for t in turns]
    inside = [(r - 3.5, z + 3.0) for r, z in outside[::-1]]
    inside[0] = (inside[0][0], outside[-1][1])
    builder.add("ceramic", builder.lathe([(0.0, -31.0), (25.0, -31.0), *outside, *inside,
                                          (0.0, -25.0)]))
    return []


def can(builder, random):
    """A food can with a rim, a pull tab, and a printed paper sleeve (`fine`)."""
    body = [(0.0, -52.0), (33.0, -52.0), (34.5, -50.5), (34.5, -48.0), (33.0, -47.0), (33.0, 47.0),
            (34.5, 48.0), (34.5, 52.0), (32.5, 52.0), (32.5, 48.5), (0.0, 48.5)]
    builder.add("steel", builder.lathe(body))
    builder.add("steel", shapes.box(24.0, 12.0, 48.0, 50.8, 14.0, 0.0))
    if builder.fine:
        builder.add("label", _printed_arc(33.05, -3.1, 3.1, -44.0, 44.0))
        for _ in range(9):
            start, low = random.uniform(-3.0, 2.2), random.uniform(-42.0, 30.0)
            builder.add("black", _printed_arc(33.1, start, start + random.uniform(0.2, 0.8), low,
                                              low + random.uniform(2.0, 12.0)))
    return []


def bottle(builder, random):
    """A detergent bottle of oval section with a cap; `fine` has a printed label."""
    rings = [(44.0, 24.0, 3.0, -100.0), (46.0, 26.0, 3.0, -97.0), (46.0, 26.0, 3.0, 40.0),
             (30.0, 22.0, 2.4, 68.0), (13.0, 13.0, 2.0, 76.0), (13.0, 13.0, 2.0, 80.0)]
    builder.add("paint", loft(rings, 240 if builder.fine else 72))
    builder.add("black", builder.lathe([(16.0, 79.0), (16.0, 100.0), (0.0, 100.0)]))
    if builder.fine:
        for side in (-1, 1):
            panel = shapes.box(56.0, 2.0, -80.0, 20.0, 0.0, side * 25.2)
            builder.add("label", panel)
            for _ in range(6):
                low, x = random.uniform(-76.0, 8.0), random.uniform(-16.0, 16.0)
                builder.add("black", shapes.box(random.uniform(6.0, 22.0), 2.1, low,
                                                low + random.uniform(2.0, 9.0), x, side * 25.2))
    return []


def carton(builder, random):
    """A carton with print on all visible faces (`fine`)."""
    size = np.array([110.0, 60.0, 160.0])
    builder.add("paint", shapes.box(size[0], size[1], -0.5 * size[2], 0.5 * size[2]))
    if not builder.fine:
        return []
    for side in range(5):
        for _ in range(7):
            _print_on_carton(builder, random, side, size)
    return []


def _print_on_carton(builder, random, side, size):
    """A rectangle of ink, 0.05 mm proud: sides 0 to 3 around, 4 on top."""
    material = random.choice(("black", "dark", "foil"))
    width, height = (random.uniform(6.0, 34.0) for _ in range(2))
    if side == 4:
        x, y = (random.uniform(-0.5, 0.5) * (s - 40.0) for s in size[:2])
        builder.add(material, shapes.box(width, min(height, 14.0), 79.9, 80.05, x, y))
        return
    across, depth = (size[0], size[1]) if side % 2 == 0 else (size[1], size[0])
    x, z = random.uniform(-0.5, 0.5) * (across - 36.0), random.uniform(-60.0, 45.0)
    ink = shapes.box(min(width, across - 36.0), 0.2, z, z + height, x, 0.5 * depth - 0.05)
    builder.add(material, ink.moved(turn_rad=0.5 * math.pi * side))


def _printed_arc(radius, start, stop, low, high):
    """A sheet around a cylinder, between two angles and two heights."""
    outline = shapes.arc(radius - 0.2, radius, start, stop, max(8, int(40 * (stop - start))))
    return shapes.prism(outline, low, high)


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
