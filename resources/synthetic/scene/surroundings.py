# SPDX-License-Identifier: Apache-2.0
"""What stands around a station, in millimetres of the station frame: ground and rocks, the
vehicle's deck and boxes, cables, and what throws shadows from outside of the picture."""

import math

import numpy as np

from . import shapes
from .shapes import Solid


def frame_with_z(direction):
    """A rotation whose third column is the given direction."""
    z = np.asarray(direction, dtype=np.float64)
    z = z / np.linalg.norm(z)
    x = np.cross([0.2, 1.0, 0.1], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def _smooth_noise(shape, cells, generator):
    """Value noise on a grid, -1 .. 1, with `cells` lattice cells a side."""
    lattice = generator.uniform(-1.0, 1.0, (cells + 2, cells + 2))
    rows = np.linspace(0, cells, shape[0])
    columns = np.linspace(0, cells, shape[1])
    r, c = rows.astype(int), columns.astype(int)
    fr, fc = rows - r, columns - c
    fr, fc = (fr * fr * (3 - 2 * fr))[:, None], (fc * fc * (3 - 2 * fc))[None, :]
    top = lattice[np.ix_(r, c)] * (1 - fc) + lattice[np.ix_(r, c + 1)] * fc
    low = lattice[np.ix_(r + 1, c)] * (1 - fc) + lattice[np.ix_(r + 1, c + 1)] * fc
    return top * (1 - fr) + low * fr


def ground(up, depth, generator):
    """A rolling plain, 80 m wide, `depth` under the station."""
    count, half = 300, 40000.0
    # Closer together near the station, where it is looked at.
    along = np.sinh(np.linspace(-4.6, 4.6, count)) / math.sinh(4.6) * half
    x, y = np.meshgrid(along, along)
    height = sum(amplitude * _smooth_noise(x.shape, cells, generator)
                 for amplitude, cells in ((90, 7), (34, 26), (9, 80), (4, 170)))
    vertices = np.column_stack([x.ravel(), y.ravel(), height.ravel() - depth])
    return Solid(vertices, _grid(count)).placed(frame_with_z(up), [0, 0, 0])


class _Relief:
    """Value noise in the plane, of period 64 cells, for metric coordinates."""

    def __init__(self, generator):
        self.lattice = generator.uniform(-1.0, 1.0, (64, 64))

    def at(self, x, y, wavelength):
        x, y = x / wavelength, y / wavelength
        i, j = np.floor(x).astype(int), np.floor(y).astype(int)
        fx, fy = x - i, y - j
        fx, fy = fx * fx * (3 - 2 * fx), fy * fy * (3 - 2 * fy)
        i, j, i1, j1 = i % 64, j % 64, (i + 1) % 64, (j + 1) % 64
        low = self.lattice[i, j] * (1 - fx) + self.lattice[i1, j] * fx
        return low * (1 - fy) + (self.lattice[i, j1] * (1 - fx) + self.lattice[i1, j1] * fx) * fy


def near_ground(up, depth, generator):
    """Soil that an object lies on: a plain 80 m wide, 2 mm fine where it is looked at, and level
    under the object."""
    count, half, bend = 440, 40000.0, 8.0
    along = np.sinh(np.linspace(-bend, bend, count)) / math.sinh(bend) * half
    x, y = np.meshgrid(along, along)
    near = np.clip(np.hypot(x, y) / 400.0, 0.0, 1.0) ** 2
    height = sum(amplitude * _Relief(generator).at(x, y, wavelength) for amplitude, wavelength in
                 ((0.25, 7.0), (0.6, 26.0)))
    height = height + near * sum(amplitude * _Relief(generator).at(x, y, wavelength)
                                 for amplitude, wavelength in ((9, 130.0), (30, 700.0), (120, 5000.0)))
    vertices = np.column_stack([x.ravel(), y.ravel(), height.ravel() - depth])
    return Solid(vertices, _grid(count)).placed(frame_with_z(up), [0, 0, 0])


def _grid(count):
    """Triangles of a square grid of `count` vertices a side."""
    corner = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
    return np.vstack([np.column_stack([corner, corner + 1, corner + count + 1]),
                      np.column_stack([corner, corner + count + 1, corner + count])])


def pebbles(up, depth, clear, count, generator):
    """Small stones around an object, none within `clear` of its middle."""
    turn = frame_with_z(up)
    made = Solid()
    for i in range(count):
        distance = clear + (260.0 if i < count // 2 else 1500.0) * generator.uniform()
        angle = generator.uniform(0.0, 2 * math.pi)
        radius = min(1.5 + 24.0 * generator.uniform() ** 5, 0.45 * (distance - clear) + 1.5)
        place = [distance * math.cos(angle), distance * math.sin(angle), 0.25 * radius - depth]
        made.add(rock(radius, generator).placed(turn, turn @ place))
    return made


def litter(up, depth, clear, generator):
    """A cable and a box on the ground near an object: solids by material."""
    turn, angle = frame_with_z(up), generator.uniform(0, 2 * math.pi)
    offset = clear + generator.uniform(12, 90)
    path = np.column_stack([np.linspace(-500, 500, 9), offset + generator.normal(0, 9, 9).cumsum(),
                            np.full(9, 4.0 - depth)])
    path[:, 1] = np.maximum(path[:, 1], clear + 8.0)
    cable = shapes.sweep(shapes.spline(path, 14), generator.uniform(2.5, 5.0))
    distance, side = clear + generator.uniform(90, 170), angle + generator.uniform(2.0, 4.3)
    box = shapes.box(generator.uniform(50, 90), generator.uniform(50, 110), -20 - depth,
                     generator.uniform(25, 70) - depth, 0.0, 0.0, generator.uniform(0, 3.1))
    box = box.moved(distance * math.cos(side), distance * math.sin(side))
    return {"cable": cable.moved(turn_rad=angle - 0.5 * math.pi).placed(turn, [0, 0, 0]),
            "bracket": box.placed(turn, [0, 0, 0])}


def rock(radius, generator):
    """A lump with flattened faces."""
    rings, sides = 18, 26
    polar = np.linspace(0.0, math.pi, rings)
    azimuth = np.linspace(0.0, 2 * math.pi, sides, endpoint=False)
    p, a = np.meshgrid(polar, azimuth, indexing="ij")
    points = np.stack([np.sin(p) * np.cos(a), np.sin(p) * np.sin(a), np.cos(p)], -1).reshape(-1, 3)
    reach = np.ones(len(points))
    for _ in range(16):
        normal = generator.normal(size=3)
        normal /= np.linalg.norm(normal)
        along = points @ normal
        cut = generator.uniform(0.62, 0.95)
        reach = np.where(along > 0, np.minimum(reach, cut / np.maximum(along, 1e-6)), reach)
    reach += generator.normal(0.0, 0.012, len(points))
    points *= (radius * reach)[:, None] * [1.0, generator.uniform(0.6, 1.0), generator.uniform(0.4, 0.8)]
    here, there = np.arange(sides), np.roll(np.arange(sides), -1)
    triangles = []
    for i in range(rings - 1):
        a, b = i * sides, (i + 1) * sides
        triangles += [np.column_stack([a + here, b + here, b + there]),
                      np.column_stack([a + here, b + there, a + there])]
    return Solid(points, np.vstack(triangles))


def rocks(up, depth, count, generator):
    """Lumps strewn over the ground."""
    turn = frame_with_z(up)
    made = Solid()
    for _ in range(count):
        distance = 150.0 + 2600.0 * generator.uniform() ** 1.6
        angle = generator.uniform(0.0, 2 * math.pi)
        radius = 12.0 + 130.0 * generator.uniform() ** 4 * min(1.0, distance / 700.0)
        place = [distance * math.cos(angle), distance * math.sin(angle), 0.2 * radius - depth]
        made.add(rock(radius, generator).placed(turn, turn @ place))
    return made


def deck(station, generator):
    """The vehicle under and around a station: solids by material."""
    side = float(generator.uniform(-120, 120))
    low = {"bc": -95.0, "os": -110.0}[station]
    made = {"paint": shapes.box(520, 420, low - 160, low, side, float(generator.uniform(-90, 90)),
                                float(generator.uniform(-0.3, 0.3))),
            "bracket": Solid(), "cable": Solid(), "foil": Solid()}
    for _ in range(int(generator.integers(5, 10))):
        angle, distance = generator.uniform(0, 2 * math.pi), generator.uniform(235, 520)
        width, depth, height = generator.uniform(30, 120, 3)
        material = ("paint", "bracket", "foil")[int(generator.integers(0, 3))]
        # Down into the ground: some stand next to the deck.
        made[material].add(shapes.box(width, depth, -1500, low + height,
                                      distance * math.cos(angle), distance * math.sin(angle),
                                      generator.uniform(0, 3.1)))
    for _ in range(int(generator.integers(3, 7))):
        made["cable"].add(_cable(low, generator))
    return made


def _cable(low, generator):
    """A cable that comes out of the deck and runs around the station, outside of 165 mm."""
    angle = generator.uniform(0, 2 * math.pi)
    points = []
    for _ in range(5):
        distance = generator.uniform(178, 330)
        points.append([distance * math.cos(angle), distance * math.sin(angle),
                       low + generator.uniform(5, 120)])
        angle += generator.uniform(0.15, 0.55)
    points[0][2] = points[-1][2] = low - 10
    return shapes.sweep(shapes.spline(points, 14), generator.uniform(2.5, 6.5))


def shadow_casters(towards_sun, sees, count, generator):
    """Beams and cables between the sun and the station, none of it where a camera looks.

    `sees` says for points (n x 3, mm) whether any camera has one in its picture.
    """
    made = Solid()
    turn = frame_with_z(towards_sun)
    for _ in range(60):
        if count == 0:
            break
        distance, angle = generator.uniform(260, 900), generator.uniform(0, math.pi)
        offset = generator.uniform(-110, 110)
        if generator.uniform() < 0.55:
            solid = shapes.box(generator.uniform(900, 1500), generator.uniform(6, 45), distance - 12,
                               distance + 12).moved(y=offset)
        else:
            path = np.column_stack([np.linspace(-600, 600, 9), offset + generator.normal(0, 40, 9),
                                    distance + generator.normal(0, 15, 9)])
            solid = shapes.sweep(shapes.spline(path, 8), generator.uniform(4, 12))
        solid = solid.moved(turn_rad=angle).placed(turn, [0, 0, 0])
        if not sees(_dense(solid)):
            made.add(solid)
            count -= 1
    return made


def _dense(solid, spacing=5.0):
    """Points all over a solid's triangles, at most that far apart (mm): a beam in front of the
    camera fills the picture, yet few of its places are in view."""
    corners = solid.vertices[solid.triangles]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    steps = np.ceil(edges.max(axis=1) / spacing).astype(int)
    points = []
    for n in np.unique(steps):
        i, j = (index.ravel() for index in np.mgrid[:n + 1, :n + 1])
        inside = i + j <= n
        i, j = i[inside, None] / n, j[inside, None] / n
        a, b, c = (corners[steps == n, None, k] for k in range(3))
        points.append((a + i * (b - a) + j * (c - a)).reshape(-1, 3))
    return np.vstack(points)


def occluder(camera_place, reach, generator):
    """For hard cases: a tool of the arm between camera and station, over a point `reach` from its
    middle."""
    angle = generator.uniform(0, 2 * math.pi)
    middle = np.array([reach * math.cos(angle), reach * math.sin(angle), 0.0])
    high = 0.35 * np.asarray(camera_place) + 0.65 * middle
    far = middle + np.array([330 * math.cos(angle), 330 * math.sin(angle), 60.0])
    made = shapes.sweep(shapes.spline([high, 0.5 * (high + far) + [0, 0, 25], far], 20),
                        generator.uniform(11, 17), 40)
    return made.add(shapes.box(52, 40, 0, 34, turn_rad=angle).moved(*high))
