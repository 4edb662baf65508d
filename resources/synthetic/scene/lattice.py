# SPDX-License-Identifier: Apache-2.0
"""The canister's sleeves: a hexagonal lattice, in millimetres of the station frame. Needs no Blender."""

import math

OS_PITCH_MM = 33.0
OS_KEYED = {(0, 0)}
OS_BARE = {(3, -3), (-1, -2), (-2, 3)}  # occupied by the marks


def canister_lattice():
    """Place (x, y) of every lattice index inside of the rim."""
    made = {}
    for i in range(-4, 5):
        for j in range(-4, 5):
            x = OS_PITCH_MM * (i + 0.5 * j)
            y = OS_PITCH_MM * math.sqrt(0.75) * j
            if math.hypot(x, y) < 104:
                made[(i, j)] = (x, y)
    return made


def canister_sleeves():
    """The lattice without the places that hold no sleeve."""
    return {k: p for k, p in canister_lattice().items() if k not in OS_KEYED | OS_BARE}


def is_at_rim(index):
    """Whether a lattice place has fewer than six neighbours."""
    i, j = index
    places = canister_lattice()
    steps = ((1, 0), (-1, 0), (0, 1), (0, -1), (1, -1), (-1, 1))
    return not all((i + di, j + dj) in places for di, dj in steps)
