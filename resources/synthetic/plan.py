# SPDX-License-Identifier: Apache-2.0
"""Draws the cases: what stands where, who looks at it from where, and what the arm believes.

A case depends on the seed, its station and its number alone, so that a larger set begins with the
smaller one. Poses are 4x4 lists, metres, camera as OpenCV has it (x right, y down, z forward).
"""

import math
import random

SIDE_px = 2048
CAMERAS = {
    "left_pinhole": {"model": "pinhole", "fx": 3105.0, "fy": 3105.0, "cx": 1029.8, "cy": 1018.8},
    "left_barrel": {"model": "brown_conrady", "fx": 3105.0, "fy": 3105.0, "cx": 1029.8,
                    "cy": 1018.8, "dist": [-0.12, 0.06, 0.0004, -0.0003, 0.0]},
    "left_cushion": {"model": "brown_conrady", "fx": 3105.0, "fy": 3105.0, "cx": 1029.8,
                     "cy": 1018.8, "dist": [0.08, -0.05, -0.0002, 0.0003, 0.0]},
    "right_pinhole": {"model": "pinhole", "fx": 3092.0, "fy": 3092.0, "cx": 1019.1, "cy": 1027.4},
    "right_barrel": {"model": "brown_conrady", "fx": 3092.0, "fy": 3092.0, "cx": 1019.1,
                     "cy": 1027.4, "dist": [-0.105, 0.05, -0.0003, 0.0002, 0.01]},
    "right_cushion": {"model": "brown_conrady", "fx": 3092.0, "fy": 3092.0, "cx": 1019.1,
                      "cy": 1027.4, "dist": [0.065, -0.03, 0.0003, 0.0002, 0.0]},
}
LENSES = (("pinhole", 0.5), ("barrel", 0.3), ("cushion", 0.2))
BASELINE_m, TOE_IN_deg = 0.10, 11.0

# What is declared, and what is drawn: ellipsoids of these half axes (the published input errors).
STATIONS = {
    "bc": {"standoff_m": (0.400, 0.435), "feature_size_m": 0.015, "end_effector_m": 0.39,
           "declared_m": [0.030, 0.030, 0.030], "declared_deg": [5.5, 5.5, 5.5],
           "drawn_m": [0.030, 0.030, 0.020], "drawn_deg": 5.0},
    "os": {"standoff_m": (0.380, 0.412), "feature_size_m": 0.018, "end_effector_m": 0.37,
           "declared_m": [0.016, 0.016, 0.0145], "declared_deg": [2.2, 2.2, 2.2],
           "drawn_m": [0.014, 0.014, 0.0115], "drawn_deg": 1.75},
}
FAR_m = (1.05, 1.30)
HARD = ("hard_occluded", "hard_overexposed", "hard_shadowed", "hard_dusty", "hard_blurred")


def camera(name, side_px=SIDE_px):
    """A camera of the pair; `side_px` other than 2048 gives the same view with other pixels."""
    made = dict(CAMERAS[name], width=side_px, height=side_px)
    scale = side_px / SIDE_px
    for key in ("fx", "fy"):
        made[key] *= scale
    for key in ("cx", "cy"):
        made[key] = (made[key] + 0.5) * scale - 0.5
    return made


def multiply(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def invert(pose):
    """The inverse of a rigid pose."""
    made = [[pose[j][i] for j in range(3)] for i in range(3)]
    move = [-sum(made[i][k] * pose[k][3] for k in range(3)) for i in range(3)]
    return [made[i] + [move[i]] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


def rotation_about(vector_rad):
    """Rodrigues' formula for a rotation vector."""
    angle = math.sqrt(sum(v * v for v in vector_rad))
    if angle < 1e-12:
        return [[float(i == j) for j in range(3)] for i in range(3)]
    x, y, z = (v / angle for v in vector_rad)
    c, s, k = math.cos(angle), math.sin(angle), 1.0 - math.cos(angle)
    return [[c + x * x * k, x * y * k - z * s, x * z * k + y * s],
            [y * x * k + z * s, c + y * y * k, y * z * k - x * s],
            [z * x * k - y * s, z * y * k + x * s, c + z * z * k]]


def pose_of(rotation, translation):
    return [list(rotation[i]) + [translation[i]] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


RIGHT_FROM_LEFT = multiply(
    pose_of(rotation_about([0.0, math.radians(TOE_IN_deg), 0.0]), [0.0, 0.0, 0.0]),
    pose_of(rotation_about([0.0, 0.0, 0.0]), [-BASELINE_m, 0.0, 0.0]))


def _unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def _cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _direction(elevation_rad, azimuth_rad):
    return [math.cos(elevation_rad) * math.cos(azimuth_rad),
            math.cos(elevation_rad) * math.sin(azimuth_rad), math.sin(elevation_rad)]


def _in_ball(draw):
    """Uniform in the unit ball."""
    while True:
        v = [draw.uniform(-1.0, 1.0) for _ in range(3)]
        if sum(x * x for x in v) <= 1.0:
            return v


def _look(draw, station, far):
    """camera_from_station of a camera over the station: tilted, rolled, off its middle."""
    standoff = draw.uniform(*(FAR_m if far else STATIONS[station]["standoff_m"]))
    tilt, azimuth = math.radians(draw.uniform(1.0, 11.0)), draw.uniform(-math.pi, math.pi)
    place = [standoff * v for v in _direction(0.5 * math.pi - tilt, azimuth)]
    reach = 0.08 if far else 0.014
    target = [draw.uniform(-reach, reach), draw.uniform(-reach, reach), 0.0]
    forward = _unit([target[i] - place[i] for i in range(3)])
    roll = math.radians(draw.gauss(0.0, 4.0) + {"bc": -6.0, "os": 3.0}[station])
    down = _unit(_cross(forward, [math.cos(roll), -math.sin(roll), 0.0]))
    right = _cross(down, forward)
    rotation = [right, down, forward]
    move = [-sum(rotation[i][k] * place[k] for k in range(3)) for i in range(3)]
    return pose_of(rotation, move)


def _seed_error(draw, station):
    """seed_from_true of the left camera's frame, pivot at the camera (conventions: p_true =
    Exp(r) p_seed + t), so that both cameras of the pair lie in the declared box."""
    limits = STATIONS[station]
    while True:
        move = [a * b for a, b in zip(_in_ball(draw), limits["drawn_m"])]
        turn = [math.radians(limits["drawn_deg"]) * v for v in _in_ball(draw)]
        true_from_seed = pose_of(rotation_about(turn), move)
        right = multiply(multiply(RIGHT_FROM_LEFT, true_from_seed), invert(RIGHT_FROM_LEFT))
        if all(abs(right[i][3]) <= limits["declared_m"][i] for i in range(3)):
            return invert(true_from_seed)


def _sun(draw, hard):
    """Where the sun stands over the plate, and its name."""
    if hard == "hard_shadowed":
        return "sun_back", -draw.uniform(5.0, 40.0)
    kind = draw.choices(("sun_low", "sun_mid", "sun_high", "sun_back"), (30, 42, 20, 8))[0]
    low, high = {"sun_low": (7, 25), "sun_mid": (25, 55), "sun_high": (55, 82),
                 "sun_back": (-30, -3)}[kind]
    return kind, draw.uniform(low, high)


def _scene(draw, hard):
    """What is the same for all pictures of a shot."""
    sun_name, sun_deg = _sun(draw, hard)
    dust = draw.uniform(0.75, 1.0) if hard == "hard_dusty" else draw.uniform(0.05, 0.6)
    return {"scene_seed": draw.getrandbits(31),
            "up": _unit([draw.gauss(0.0, 0.12), abs(draw.gauss(0.0, 0.45)), 1.0]),
            "towards_sun": _direction(math.radians(sun_deg), draw.uniform(-math.pi, math.pi)),
            "sun_irradiance": draw.uniform(2.4, 4.0), "sky_radiance": draw.uniform(0.09, 0.42),
            "haze_per_m": draw.uniform(0.0005, 0.004), "dust": dust,
            "ground_depth_mm": draw.uniform(420.0, 900.0), "rocks": draw.randint(40, 140),
            "shadow_casters": draw.choice((0, 1, 1, 2, 3)),
            "exposure": 2.4 if hard == "hard_overexposed" else draw.uniform(0.75, 1.15),
            "sensor": {"full_well": draw.uniform(9e3, 2.4e4), "read_noise": draw.uniform(10, 35),
                       "glare": draw.uniform(0.005, 0.03),
                       "blur_px": draw.uniform(1.6, 2.6) if hard == "hard_blurred"
                       else draw.uniform(0.0, 0.5)},
            }, ["synthetic", sun_name]


def shots(seed, station, cases, pairs=0.25, far=0.0, hard=0.0, side_px=SIDE_px):
    """Plans of all shots of a station: one picture each, or two of the pair taken at once."""
    made, number = [], 0
    while number < cases:
        draw = random.Random(f"{seed}/{station}/{number}")
        is_pair, is_far = draw.random() < pairs, draw.random() < far
        kind = draw.choice(HARD) if draw.random() < hard else None
        plan, tags = _scene(draw, kind)
        tags = tags + (["far"] if is_far else []) + (["hard", kind] if kind else [])
        left = _look(draw, station, is_far)
        seed_left = multiply(_seed_error(draw, station), left)
        lens = draw.choices([n for n, _ in LENSES], [w for _, w in LENSES])[0]
        side = "left" if is_pair or draw.random() < 0.6 else "right"
        name = f"{station}-{number:06d}"
        frames = [_frame(name, side + "_" + lens, left, seed_left, side_px)]
        if is_pair and number + 1 < cases:
            frames.append(_frame(f"{station}-{number + 1:06d}", "right_" + lens,
                                 multiply(RIGHT_FROM_LEFT, left),
                                 multiply(RIGHT_FROM_LEFT, seed_left), side_px))
        for frame, eye in zip(frames, ("left", "right") if is_pair else ("",)):
            frame["tags"] = tags + (["stereo_" + eye] if eye else [])
            if is_pair:
                frame["rig"] = {"id": name, "camera_from_rig": pose_of(rotation_about([0, 0, 0]), [0.0] * 3)
                                if eye == "left" else RIGHT_FROM_LEFT}
        made.append(dict(plan, shot=name, station=station, tags=tags, frames=frames))
        number += 2 if is_pair else 1
    return made


def _frame(name, camera_name, truth, seed, side_px):
    return {"id": name, "number": int(name[-6:]), "camera": camera_name,
            "camera_parameters": camera(camera_name, side_px), "camera_from_station": truth,
            "seed": seed}
