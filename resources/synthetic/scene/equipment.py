# SPDX-License-Identifier: Apache-2.0
"""What may be there or not, in millimetres: a lid over half of the carousel, tubes in the
canister's sleeves, a gripper in front of the camera. Files and pictures have the same shapes."""

import math

from . import shapes

SEATED_TUBE_TOP_MM = -2.0  # the pictures' tubes are within 1.5 mm of it


def lid():
    """Half a disc above the carousel's bolts, with a stiffening bar (station frame)."""
    half = shapes.arc(0.5, 134, math.radians(-20), math.radians(160), 60)
    made = shapes.prism(half, 14, 18)
    return made.add(shapes.box(190, 14, 18, 30, turn_rad=math.radians(70)).moved(20, 56))


def tube(builder):
    """A sample tube in a sleeve of the canister, about the z-axis."""
    top, radius = SEATED_TUBE_TOP_MM, 10.7
    ring = [(radius, top - 40), (radius, top), (0.82 * radius, top), (0.82 * radius, top - 2.5),
            (0.0, top - 2.5)]
    boss = [(0.34 * radius, top - 3), (0.34 * radius, top - 0.4), (0.0, top - 0.4)]
    return builder.lathe(ring).add(builder.lathe(boss))


def gripper():
    """An arm from the lower border of the picture with two fingers (camera frame)."""
    made = shapes.box(34, 130, 190, 240, 6, 85)
    for side in (-1, 1):
        made.add(shapes.box(11, 56, 182, 214, 6 + 24 * side, 12))
    return made.add(shapes.box(59, 16, 184, 222, 6, 34))



def files(station, builder):
    """Meshes of a station's equipment by the names of their files."""
    made = {"gripper": gripper()}
    if station == "bc":
        made["lid"] = lid()
    if station == "os":
        made["seated_tube"] = tube(builder)
    return made
