# SPDX-License-Identifier: Apache-2.0
"""The stations, in millimetres: x and y in the plane of the plate, z towards the camera.

`coarse` is the mesh that a localizer gets. `fine` is what is rendered: the same parts with rounder
circles, edges broken by 0.04 mm, screws, labels, sleeves filled with tubes, and wear.
"""

import math

import numpy as np

from . import objects, shapes
from .lattice import OS_PITCH_MM, canister_lattice, canister_sleeves
from .shapes import Solid

COARSE_SAGITTA_MM = 0.03
FINE_SAGITTA_MM = 0.004
BROKEN_EDGE_MM = 0.04  # wider ones move edges in the image measurably

# x, y, outer radius, inner radius, height of the rim of the carousel's sleeves
BC_SLEEVES = [(-12, 100, 24, 20, 9), (66, 78, 20.5, 17, 12), (104, 12, 17, 14, 8),
              (76, -66, 25.5, 21.5, 11), (4, -104, 19.5, 16, 7), (-70, -72, 15.5, 12.5, 10),
              (-101, -8, 21.5, 18, 8), (-79, 64, 13.5, 10.5, 6)]
BC_HOLES = [(-26, 56, 3.8), (20, 58, 3.8), (60, -14, 4.2)]
BC_BOLTS = [(30, 122), (112, 62), (124, -40), (40, -127), (-40, -122), (-118, -56), (-128, 28),
            (-112, 66), (121, 38)]


class Builder:
    """Collects solids by material; `detail` knows how round things are."""

    def __init__(self, fine):
        self.fine = fine
        self.solids = {}

    def add(self, material, solid):
        self.solids.setdefault(material, Solid()).add(solid)

    def round(self, radius, x=0.0, y=0.0):
        return shapes.circle(radius, self.sides(radius), x, y)

    def sides(self, radius):
        return shapes.segments_for(radius, FINE_SAGITTA_MM if self.fine else COARSE_SAGITTA_MM)

    def lathe(self, profile, x=0.0, y=0.0):
        sides = self.sides(max(radius for radius, _ in profile))
        return shapes.lathe(profile, sides).moved(x, y)

    def cup(self, outer, inner, foot, rim, floor):
        """The profile of a sleeve: outside up, over the rim, inside down, floor."""
        b = BROKEN_EDGE_MM if self.fine else 0.0
        if not self.fine:
            return [(outer, foot), (outer, rim), (inner, rim), (inner, floor), (0.0, floor)]
        return [(outer, foot), (outer, rim - b), (outer - b, rim), (inner + b, rim),
                (inner, rim - b), (inner, floor), (0.0, floor)]


def build(station, fine, random, target_sleeve=None):
    """The solids of a station by material, and which sleeves are filled (fine only): never the
    target, which a tube is to be put into."""
    builder = Builder(fine)
    kinds = {"bc": _carousel, "os": lambda b, r: _canister(b, r, target_sleeve),
             "tube": objects.tube, "vial": lambda b, r: objects.flask(b, r, "glass"),
             "vial_opaque": lambda b, r: objects.flask(b, r, "ceramic"),
             "mug": objects.mug, "bowl": objects.bowl, "can": objects.can,
             "bottle": objects.bottle, "carton": objects.carton}
    filled = kinds[station](builder, random)
    return builder.solids, filled


def _carousel(builder, random):
    sleeve_holes = [builder.round(0.5 * (ro + ri), x, y) for x, y, ro, ri, _ in BC_SLEEVES]
    slots = [shapes.arc(52, 68, math.radians(150), math.radians(205), 28),
             shapes.arc(50, 62, math.radians(262), math.radians(300), 20)]
    window = shapes.rectangle(28, 20, 64, 30, math.radians(8))
    holes = [builder.round(r, x, y) for x, y, r in BC_HOLES]
    plate = shapes.prism(builder.round(140), -7, 0, [*sleeve_holes, *slots, window, *holes])
    builder.add("plate", plate)
    housing = shapes.rectangle(318, 304)
    builder.add("housing", shapes.prism(housing, -62, -11, sleeve_holes))
    builder.add("rim", shapes.prism(builder.round(150), -11, 6, [builder.round(140)]))
    for x, y, outer, inner, rim in BC_SLEEVES:
        builder.add("sleeve", builder.lathe(builder.cup(outer, inner, -9, rim, -52), x, y))
    _hub(builder)
    for x, y in BC_BOLTS:
        _bolt(builder, x, y)
    _carousel_blocks(builder)
    return _carousel_details(builder, random) if builder.fine else []


def _hub(builder):
    builder.add("sleeve", builder.lathe([(36, -1), (36, 9), (27, 9), (27, 2), (0, 2)]))
    builder.add("sleeve", builder.lathe([(14, 1), (14, 14), (7.5, 14), (7.5, 6), (0, 6)]))
    builder.add("sleeve", shapes.box(14, 10, 1, 11, 32, 0))
    for angle in (80, 200, 320):
        x, y = 20.5 * math.cos(math.radians(angle)), 20.5 * math.sin(math.radians(angle))
        builder.add("steel", shapes.prism(shapes.circle(3.4, 6, x, y), 1, 5))


def _bolt(builder, x, y):
    builder.add("steel", builder.lathe([(7.5, -1), (7.5, 2), (0, 2)], x, y))
    turn = 0.37 * x + 0.11 * y
    outline = shapes.circle(5.2, 6, x, y, turn)
    socket = [shapes.circle(2.4, 6, x, y, turn + 0.3)] if builder.fine else []
    builder.add("steel", shapes.prism(outline, 1, 9, socket))


def _carousel_blocks(builder):
    turn = math.radians(34)
    builder.add("bracket", shapes.prism(shapes.rectangle(58, 34, -70, 118, turn), 7, 22,
                                        [shapes.rectangle(24, 12, -70, 118, turn)]))
    for side in (-1, 1):
        x = -70 + side * 24 * math.cos(turn)
        y = 118 + side * 24 * math.sin(turn)
        builder.add("bracket", shapes.box(8, 34, -11, 8, x, y, turn))
    builder.add("bracket", shapes.box(26, 40, -11, 16, 142, -84, math.radians(-28)))
    builder.add("bracket", shapes.box(40, 16, -11, 9, -138, -122))
    builder.add("housing", shapes.box(64, 40, -62, 4, -128, -142))
    builder.add("steel", builder.lathe([(11, -12), (11, 3), (7.5, 3), (7.5, -6), (0, -6)],
                                       134, -136))


def _carousel_details(builder, random):
    for i in range(24):
        angle = math.radians(15 * i + 4)
        _screw(builder, 145 * math.cos(angle), 145 * math.sin(angle), 6, 1.9, random)
    for x, y, outer, _, _ in BC_SLEEVES:
        for _ in range(random.randint(1, 3)):
            angle = random.uniform(0, 2 * math.pi)
            _screw(builder, x + (outer + 4) * math.cos(angle), y + (outer + 4) * math.sin(angle),
                   0, 1.2, random)
    for x, y, turn in ((20, 110, 0.2), (40, -112, 0.12), (-126, -18, 1.4), (-34, -70, 2.1)):
        builder.add("label", shapes.box(18, 6, -0.05, 0.08, x, y, turn))
    filled = [i for i in range(len(BC_SLEEVES)) if random.random() < 0.4]
    for i in filled:
        x, y, _, inner, _ = BC_SLEEVES[i]
        _tube(builder, x, y, inner - 0.8, random.uniform(-22, -3), random)
    return filled


def _canister(builder, random, target):
    lattice, sleeves = canister_lattice(), canister_sleeves()
    holes = [builder.round(12.5, x, y) for x, y in sleeves.values()]
    builder.add("dark", shapes.prism(builder.round(121), -18, -14, holes))
    for x, y in sleeves.values():
        builder.add("sleeve", builder.lathe(builder.cup(13.4, 11.6, -16, 0, -70), x, y))
    _webs(builder, sleeves)
    _canister_rim(builder)
    builder.add("steel", builder.lathe([(13, -15), (13, -6), (8.5, -6), (8.5, -11), (0, -11)]))
    builder.add("steel", shapes.box(5, 12, -15, -3, 0, 13))
    _canister_marks(builder, lattice)
    return _canister_details(builder, sleeves, random, target) if builder.fine else []


def _webs(builder, sleeves):
    for (i, j), (x, y) in sleeves.items():
        for step in ((1, 0), (0, 1), (-1, 1)):
            other = sleeves.get((i + step[0], j + step[1]))
            if other is None:
                continue
            turn = math.atan2(other[1] - y, other[0] - x)
            builder.add("sleeve", shapes.box(OS_PITCH_MM - 26, 3.2, -15, -5, 0.5 * (x + other[0]),
                                             0.5 * (y + other[1]), turn))


def _canister_rim(builder):
    """A wall around, whose top has three gaps of different widths, and a flange."""
    gaps = [(38, 52), (150, 158), (262, 290)]
    wall = shapes.prism(builder.round(128.5), -30, -4, [builder.round(120.5)])
    builder.add("rim", wall)
    after = [*gaps[1:], (gaps[0][0] + 360, 0)]
    for (_, start), (stop, _) in zip(gaps, after):
        sides = max(6, int((stop - start) / (1.2 if builder.fine else 2.4)))
        ring = shapes.arc(120.5, 128.5, math.radians(start), math.radians(stop), sides)
        builder.add("rim", shapes.prism(ring, -4.5, 6))
    builder.add("housing", shapes.prism(builder.round(142), -38, -26, [builder.round(127)]))
    builder.add("bracket", shapes.prism(shapes.rectangle(52, 20, 118, 96, 0.75), 2, 14,
                                        [shapes.rectangle(16, 8, 112, 90, 0.75)]))
    builder.add("bracket", shapes.box(20, 60, -36, 9, -146, -20, 0.12))
    builder.add("housing", shapes.prism(shapes.rectangle(300, 300), -90, -70.5))


def _canister_marks(builder, lattice):
    x, y = lattice[(3, -3)]
    builder.add("mark", shapes.prism(shapes.circle(13, 6, x, y), -15, -6,
                                     [shapes.circle(6, 6, x, y, 0.4)]))
    x, y = lattice[(-1, -2)]
    builder.add("mark", shapes.box(22, 16, -15, -7, x, y, 0.3))
    x, y = lattice[(-2, 3)]
    corner = np.array([[0, 0], [24, 0], [24, 9], [10, 9], [10, 24], [0, 24]]) - 10.0 + [x, y]
    builder.add("mark", shapes.prism(corner, -15, -6))


def _canister_details(builder, sleeves, random, target):
    for i in range(18):
        angle = math.radians(20 * i + 7)
        _screw(builder, 135 * math.cos(angle), 135 * math.sin(angle), -26, 2.2, random)
    for x, y in list(sleeves.values())[::2]:
        angle = random.uniform(0, 2 * math.pi)
        _screw(builder, x + 18.5 * math.cos(angle), y + 18.5 * math.sin(angle), -14, 1.2, random)
    keys = list(sleeves)
    filled = [i for i in range(len(sleeves)) if random.random() < 0.45]
    filled = [i for i in filled if list(keys[i]) != target]
    places = list(sleeves.values())
    for i in filled:
        _tube(builder, *places[i], 10.7, random.uniform(-3.5, -0.6), random)
    return filled


def _screw(builder, x, y, z, radius, random):
    head = shapes.lathe([(radius, -0.2), (radius, 0.5), (0.7 * radius, 0.9), (0.0, 0.9)], 24)
    builder.add("steel", head.moved(x, y, z))
    slot = shapes.box(1.5 * radius, 0.3 * radius, 0.6, 0.93, 0, 0, random.uniform(0, math.pi))
    builder.add("black", slot.moved(x, y, z))


def _tube(builder, x, y, radius, top, random):
    """A sample tube in its sleeve: a ring, a recessed cap with a boss, and a bayonet's bars,
    clocked at random."""
    ring = [(radius, top - 40), (radius, top), (0.82 * radius, top), (0.82 * radius, top - 2.5),
            (0.0, top - 2.5)]
    builder.add("tube", builder.lathe(ring, x, y))
    boss = [(0.34 * radius, top - 3), (0.34 * radius, top - 0.4), (0.0, top - 0.4)]
    builder.add("tube", builder.lathe(boss, x, y))
    clock = random.uniform(0, 2 * math.pi)
    for turn, width in ((0.0, 0.22), (2.2, 0.3)):
        bar = shapes.box(0.62 * radius, width * radius, top - 3, top - 0.9, 0.5 * radius, 0)
        builder.add("tube", bar.moved(turn_rad=clock + turn).moved(x, y))
