# SPDX-License-Identifier: Apache-2.0
"""Draws the cases: scenes, true poses and seeds.

A case depends on the seed, its station and its number alone, so that a larger set begins with the
smaller one. Poses are 4x4 lists, metres, camera as OpenCV has it (x right, y down, z forward).
"""

import math
import random

from scene.lattice import canister_sleeves, is_at_rim

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

# `error`: the largest input errors at the end effector (Table I of the paper, rows "Input"). The end
# effector is on the camera's axis. `declared`: a box that contains every truth, about the centre of
# the station's bounding box (`centre_m`). `declared_far`: the same errors drawn at the camera.
# Objects: errors about their centre, uniform in balls, declared as the balls' radii.
# The arm's stations: the "worst-case input uncertainties" of Sec. III-A, "e.g." +-30 mm and +-5 deg
# on each axis (bc), each station's own by Table I, and as much wider as the station's centre and the
# roll of the camera need.
OBJECT_DECLARED = {"translation_m": [0.030] * 3, "rotation_deg": [10.0] * 3, "pivot": "station"}
STATIONS = {
    "bc": {"standoff_m": (0.400, 0.435), "feature_size_m": 0.015, "end_effector_m": 0.39,
           "centre_m": [0.001434, -0.005, -0.020], "tilt_deg": (1.0, 11.0), "roll_deg": (-6.0, 4.0),
           "error": {"normal_m": 0.020, "lateral_m": 0.030, "tilt_deg": 5.0},
           "declared": {"translation_m": [0.036, 0.036, 0.030], "rotation_deg": [5.5, 5.5, 6.0],
                        "pivot": "station"},
           "declared_far": {"translation_m": [0.033, 0.040, 0.030], "rotation_deg": [5.5, 5.5, 6.0],
                            "pivot": "camera"}},
    "os": {"standoff_m": (0.380, 0.412), "feature_size_m": 0.018, "end_effector_m": 0.37,
           "centre_m": [-0.00476, 0.0, -0.038], "tilt_deg": (1.0, 11.0), "roll_deg": (3.0, 4.0),
           "error": {"normal_m": 0.0115, "lateral_m": 0.014, "tilt_deg": 1.75},
           "declared": {"translation_m": [0.022, 0.022, 0.015], "rotation_deg": [1.9, 1.9, 5.5],
                        "pivot": "station"},
           "declared_far": {"translation_m": [0.016, 0.024, 0.016], "rotation_deg": [1.9, 1.9, 5.5],
                            "pivot": "camera"}},
    "tube": {"standoff_m": (0.380, 0.440), "feature_size_m": 0.020, "end_effector_m": 0.37,
             "centre_m": [0.0, 0.00112, 0.00054], "tilt_deg": (2.0, 28.0), "roll_deg": (0.0, 180.0),
             "declared": OBJECT_DECLARED, "requirement": {"projection_px": 2.0}},
    "vial": {"standoff_m": (0.300, 0.360), "feature_size_m": 0.015, "end_effector_m": 0.37,
             "centre_m": [0.0, 0.0, 0.0], "tilt_deg": (5.0, 40.0), "roll_deg": (0.0, 180.0),
             "declared": OBJECT_DECLARED, "requirement": {"projection_px": 2.0}},
}
STATIONS["vial_opaque"] = dict(STATIONS["vial"], drawn_as="vial")  # same draws, other material
HOUSEHOLD = {"mug": [0.01373, 0.0, 0.0], "bowl": [0.0, 0.0, -0.00695], "can": [0.0, 0.0, 0.0],
             "bottle": [0.0, 0.0, 0.0], "carton": [0.0, 0.0, 0.0]}  # centre_m
for _name, _centre_m in HOUSEHOLD.items():
    STATIONS[_name] = {"standoff_m": (0.55, 0.80), "feature_size_m": 0.025, "end_effector_m": 0.5,
                       "centre_m": _centre_m, "tilt_deg": (25.0, 65.0), "roll_deg": (0.0, 15.0),
                       "declared": OBJECT_DECLARED, "requirement": {"projection_px": 2.0}}
# Every turn about this axis through the origin looks the same, but for the print.
STATIONS["bowl"]["symmetries"] = {"continuous": [{"axis": [0, 0, 1], "point_m": [0, 0, 0]}]}
BOP_OBJECTS = {name: i + 1 for i, name in enumerate(STATIONS)}  # numbers of objects and scenes
LYING = ("tube", "vial", "vial_opaque", *HOUSEHOLD)  # on the ground
IN_PLANE_deg = 5.0  # "a 10 deg uncertainty window from kinematics" (Sec. V-A), both stations
IN_PLANE_DECLARED = {"translation_m": [0.020] * 3, "rotation_deg": [12.5, 5.5, 40.0],
                     "pivot": "station"}  # of the tube's hard_in_plane
FAR_m = (1.05, 1.30)
HARD = ("hard_occluded", "hard_overexposed", "hard_shadowed", "hard_dusty", "hard_blurred")
HARD_OF = {"tube": HARD + ("hard_in_plane",)}  # seeds turned towards the shadow, Fig. 5


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


def _look(draw, station, far, target_m):
    """camera_from_station of a camera over the station: tilted, rolled, aimed at `target_m`
    (x, y), or near the station's middle where that is None."""
    limits = STATIONS[station]
    standoff = draw.uniform(*(FAR_m if far else limits["standoff_m"]))
    tilt, azimuth = math.radians(draw.uniform(*limits["tilt_deg"])), draw.uniform(-math.pi, math.pi)
    reach = 0.08 if far else 0.014
    aside = [draw.uniform(-reach, reach), draw.uniform(-reach, reach)]
    target = [*(target_m or aside), 0.0]
    place = [standoff * v for v in _direction(0.5 * math.pi - tilt, azimuth)]
    if target_m:
        place = [p + t for p, t in zip(place, target)]
    forward = _unit([target[i] - place[i] for i in range(3)])
    middle, spread = limits["roll_deg"]
    turned = draw.uniform(-spread, spread) if station in LYING else draw.gauss(0.0, spread)
    roll = math.radians(middle + turned)
    if station in HOUSEHOLD:  # what stands is upright in the picture
        roll -= azimuth + 0.5 * math.pi
    down = _unit(_cross(forward, [math.cos(roll), -math.sin(roll), 0.0]))
    right = _cross(down, forward)
    rotation = [right, down, forward]
    move = [-sum(rotation[i][k] * place[k] for k in range(3)) for i in range(3)]
    return pose_of(rotation, move)


def displaced(turn, move, point):
    """p -> R (p - point) + point + move, with R of the rotation vector `turn`."""
    rotation = rotation_about(turn)
    moved = [sum(rotation[i][k] * point[k] for k in range(3)) for i in range(3)]
    return pose_of(rotation, [point[i] + move[i] - moved[i] for i in range(3)])


def point_of(pose, point):
    return [sum(pose[i][k] * point[k] for k in range(3)) + pose[i][3] for i in range(3)]


def error_at(true_from_seed, point):
    """Normal (m, signed), lateral (m) and out-of-plane rotation (rad) at `point` of the true
    camera's frame: d = R p + t - p, angle(z, R z)."""
    d = [a - b for a, b in zip(point_of(true_from_seed, point), point)]
    tilt = math.atan2(math.hypot(true_from_seed[0][2], true_from_seed[1][2]), true_from_seed[2][2])
    return d[2], math.hypot(d[0], d[1]), tilt


def offset_about(true_from_seed, pivot):
    """(rotation vector rad, translation m) as an uncertainty is declared: p_true = Exp(r) (p_seed -
    c) + c + t, with the pivot c in the seed camera's frame."""
    e = true_from_seed
    angle = math.acos(max(-1.0, min(1.0, 0.5 * (e[0][0] + e[1][1] + e[2][2] - 1.0))))
    scale = 0.5 if angle < 1e-9 else 0.5 * angle / math.sin(angle)
    turn = [scale * (e[2][1] - e[1][2]), scale * (e[0][2] - e[2][0]), scale * (e[1][0] - e[0][1])]
    return turn, [a - b for a, b in zip(point_of(e, pivot), pivot)]


def pivot_of(station, declared, seed_pose):
    """Of a declared uncertainty, in the seed camera's frame (m)."""
    if declared["pivot"] == "camera":
        return [0.0] * 3
    return point_of(seed_pose, STATIONS[station]["centre_m"])


def is_declared(true_from_seed, declared, pivot):
    """Whether the truth lies in the box."""
    turn, move = offset_about(true_from_seed, pivot)
    return all(abs(m) <= limit for m, limit in zip(move, declared["translation_m"])) and all(
        abs(math.degrees(t)) <= limit for t, limit in zip(turn, declared["rotation_deg"]))


def in_right(in_left):
    """A transform of the left camera's frame, in the right one's."""
    return multiply(multiply(RIGHT_FROM_LEFT, in_left), invert(RIGHT_FROM_LEFT))


def _share(draw):
    """Share of the largest error: the law 1 - u^1.3 has Table I's mean and deviation to 3 %, for
    all three errors and both stations (uniform in a ball or cylinder: up to 30 % off)."""
    return 1.0 - draw.random() ** 1.3


def _draw_mounted_error(draw, largest, point):
    """true_from_seed with the law's errors at `point`."""
    normal = largest[0] * _share(draw) * draw.choice((-1.0, 1.0))
    lateral, towards = largest[1] * _share(draw), draw.uniform(-math.pi, math.pi)
    tilt, about = largest[2] * _share(draw), draw.uniform(-math.pi, math.pi)
    in_plane = math.radians(draw.uniform(-IN_PLANE_deg, IN_PLANE_deg))
    turn = multiply(pose_of(rotation_about([tilt * math.cos(about), tilt * math.sin(about), 0.0]),
                            [0.0] * 3), pose_of(rotation_about([0.0, 0.0, in_plane]), [0.0] * 3))
    move = [lateral * math.cos(towards), lateral * math.sin(towards), normal]
    turned = point_of(turn, point)
    return pose_of([row[:3] for row in turn[:3]], [point[i] + move[i] - turned[i] for i in range(3)])


def _largest_error(station, is_far):
    """Largest normal (m), lateral (m) and out-of-plane (rad) error, and the point in the camera
    frame (m) that they hold at."""
    limits = STATIONS[station]["error"]
    point = [0.0, 0.0, 0.0 if is_far else STATIONS[station]["end_effector_m"]]
    return (limits["normal_m"], limits["lateral_m"], math.radians(limits["tilt_deg"])), point


def _mounted_error(draw, station, seed_left, is_pair, is_far):
    """camera_true_from_camera_seed of the left camera, with Table I's errors at the end effector
    (far: at the camera). Both cameras of a pair have it within the largest errors and within the
    declared box."""
    declared = STATIONS[station]["declared_far" if is_far else "declared"]
    largest, point = _largest_error(station, is_far)
    point_right, seed_right = point_of(RIGHT_FROM_LEFT, point), multiply(RIGHT_FROM_LEFT, seed_left)
    while True:
        error = _draw_mounted_error(draw, largest, point)
        right = in_right(error)
        found = is_declared(error, declared, pivot_of(station, declared, seed_left))
        if is_pair and found:
            found = all(abs(e) <= limit for e, limit in zip(error_at(right, point_right), largest))
            found = found and is_declared(right, declared, pivot_of(station, declared, seed_right))
        if found:
            return error


def _object_error(draw, seed_pose, station, hard):
    """camera_true_from_camera_seed, about the object's centre."""
    centre = point_of(seed_pose, STATIONS[station]["centre_m"])
    if hard == "hard_in_plane":
        turn = [math.radians(5.0) * v for v in _in_ball(draw)]
        turn[2] = math.radians(draw.uniform(22.0, 38.0)) * draw.choice((-1.0, 1.0))
        return displaced(turn, [0.020 * v for v in _in_ball(draw)], centre)
    limits = STATIONS[station]["declared"]
    move = [a * b for a, b in zip(_in_ball(draw), limits["translation_m"])]
    return displaced([math.radians(limits["rotation_deg"][0]) * v for v in _in_ball(draw)], move,
                     centre)


def further_seed(shot, frame, index):
    """camera_from_station of another seed of a picture, by the law of its first one."""
    station, truth = shot["station"], frame["camera_from_station"]
    draw = random.Random(f"{shot['scene_seed']}/{frame['id']}/{index}")
    hard = next((tag for tag in frame["tags"] if tag.startswith("hard_")), None)
    is_far = "far" in frame["tags"]
    declared = declared_uncertainty(station, frame["tags"])
    while True:
        if station in LYING:
            return multiply(invert(_object_error(draw, truth, station, hard)), truth)
        largest, point = _largest_error(station, is_far)
        if "camera_from_end_effector" in frame and not is_far:  # the right camera of a pair
            point = [row[3] for row in frame["camera_from_end_effector"][:3]]
        error = _draw_mounted_error(draw, largest, point)
        seed = multiply(invert(error), truth)
        if is_declared(error, declared, pivot_of(station, declared, seed)):
            return seed


def declared_uncertainty(station, tags):
    """What a case declares (fields of dataset.json)."""
    if "hard_in_plane" in tags:
        return IN_PLANE_DECLARED
    limits = STATIONS[station]
    return limits["declared_far" if "far" in tags and station not in LYING else "declared"]


def _sun(draw, station, hard):
    """Where the sun stands over the plate or the ground, and its name."""
    if station in LYING:
        if hard == "hard_shadowed":
            return "sun_low", draw.uniform(5.0, 9.0)
        kind = draw.choices(("sun_low", "sun_mid", "sun_high"), (40, 45, 15))[0]
        low, high = {"sun_low": (10, 25), "sun_mid": (25, 55), "sun_high": (55, 80)}[kind]
        return kind, draw.uniform(low, high)
    if hard == "hard_shadowed":
        return "sun_back", -draw.uniform(5.0, 40.0)
    kind = draw.choices(("sun_low", "sun_mid", "sun_high", "sun_back"), (30, 42, 20, 8))[0]
    low, high = {"sun_low": (7, 25), "sun_mid": (25, 55), "sun_high": (55, 82),
                 "sun_back": (-30, -3)}[kind]
    return kind, draw.uniform(low, high)


def _scene(draw, station, hard):
    """What is the same for all pictures of a shot."""
    sun_name, sun_deg = _sun(draw, station, hard)
    dust = draw.uniform(0.75, 1.0) if hard == "hard_dusty" else draw.uniform(0.05, 0.6)
    return {"scene_seed": draw.getrandbits(31),
            "up": _up(draw, station),
            "towards_sun": _direction(math.radians(sun_deg), draw.uniform(-math.pi, math.pi)),
            "sun_irradiance": draw.uniform(2.4, 4.0), "sky_radiance": draw.uniform(0.09, 0.42),
            "haze_per_m": draw.uniform(0.0005, 0.004), "dust": dust,
            "ground_depth_mm": draw.uniform(420.0, 900.0), "rocks": draw.randint(40, 140),
            "shadow_casters": draw.choice((0, 0, 1) if station in LYING else (0, 1, 1, 2, 3)),
            "exposure": 2.4 if hard == "hard_overexposed" else draw.uniform(0.75, 1.15),
            "sensor": {"full_well": draw.uniform(9e3, 2.4e4), "read_noise": draw.uniform(10, 35),
                       "glare": draw.uniform(0.005, 0.03),
                       "blur_px": draw.uniform(1.6, 2.6) if hard == "hard_blurred"
                       else draw.uniform(0.0, 0.5)},
            }, ["synthetic", sun_name]


def _sun_behind(camera_from_station, seed, name):
    """Light from about the camera's side, 15 to 35 deg from the view axis: drawn apart from
    everything else, which stays as it is."""
    draw = random.Random(f"{seed}/{name}/sun")
    towards = _direction(math.radians(90.0 - draw.uniform(15.0, 35.0)),
                         draw.uniform(-math.pi, math.pi))
    # The camera looks along its +z.
    in_camera = [towards[0], towards[1], -towards[2]]
    return [sum(camera_from_station[k][i] * in_camera[k] for k in range(3)) for i in range(3)]


def _up(draw, station):
    """Direction away from the ground, station frame."""
    if station in LYING:
        return _unit([draw.gauss(0.0, 0.03), draw.gauss(0.0, 0.03), 1.0])
    return _unit([draw.gauss(0.0, 0.12), abs(draw.gauss(0.0, 0.45)), 1.0])


def _target(draw, station):
    """Lattice index of the canister's sleeve that the end effector is over; None elsewhere."""
    return list(draw.choice(sorted(canister_sleeves()))) if station == "os" else None


def _sleeve_tags(sleeve):
    return [] if sleeve is None else ["sleeve_rim" if is_at_rim(sleeve) else "sleeve_inner"]


def _state(seed, station, number):
    """What a picture with a drawn state shows, drawn apart from everything else."""
    draw = random.Random(f"{seed}/{station}/{number}/state")
    equipment = ["gripper"] + (["lid"] if station == "bc" else [])
    return [name for name in equipment if draw.random() < 0.5]


def shots(seed, station, cases, pairs=0.25, far=0.0, hard=0.0, side_px=SIDE_px, state=False,
          sun_behind=False):
    """Plans of all shots of a station: one picture each, or two of the pair taken at once."""
    made, number = [], 0
    while number < cases:
        drawn_as = STATIONS[station].get("drawn_as", station)
        draw = random.Random(f"{seed}/{drawn_as}/{number}")
        is_pair, is_far = draw.random() < pairs, draw.random() < far
        kind = draw.choice(HARD_OF.get(station, HARD)) if draw.random() < hard else None
        plan, tags = _scene(draw, station, kind)
        tags = tags + (["far"] if is_far else []) + (["hard", kind] if kind else [])
        tags += ["transparent"] if station == "vial" else []
        plan["target_sleeve"], plan["lying"] = _target(draw, station), station in LYING
        tags += _sleeve_tags(plan["target_sleeve"])
        plan["occluder_reach_mm"] = 20.0 if plan["lying"] else 62.0
        left, seed_left = _poses(draw, station, plan["target_sleeve"], is_pair, is_far, kind)
        lens = draw.choices([n for n, _ in LENSES], [w for _, w in LENSES])[0]
        side = "left" if is_pair or draw.random() < 0.6 else "right"
        name = f"{station}-{number:06d}"
        frames = [_frame(name, side + "_" + lens, left, seed_left, side_px)]
        if is_pair and number + 1 < cases:
            frames.append(_frame(f"{station}-{number + 1:06d}", "right_" + lens,
                                 multiply(RIGHT_FROM_LEFT, left),
                                 multiply(RIGHT_FROM_LEFT, seed_left), side_px))
            frames[1]["camera_from_end_effector"] = multiply(RIGHT_FROM_LEFT,
                                                             camera_from_end_effector(station))
        if sun_behind:
            plan["towards_sun"] = _sun_behind(left, seed, name)
            tags = [t for t in tags if not t.startswith("sun_")] + ["sun_camera"]
        if state:
            plan["state"] = _state(seed, drawn_as, number)
            tags += ["state_" + part for part in plan["state"]]
        for frame, eye in zip(frames, ("left", "right") if is_pair else ("",)):
            frame["tags"] = tags + (["stereo_" + eye] if eye else [])
            if is_pair:
                frame["rig"] = {"id": name, "camera_from_rig": pose_of(rotation_about([0, 0, 0]), [0.0] * 3)
                                if eye == "left" else RIGHT_FROM_LEFT}
        made.append(dict(plan, shot=name, station=station, tags=tags, frames=frames))
        number += 2 if is_pair else 1
    return made


def _poses(draw, station, sleeve, is_pair, is_far, hard):
    """camera_from_station of the left camera, true and commanded. The commanded ready pose aims at
    the target; the achieved one is off by the input error."""
    target_m = [1e-3 * v for v in canister_sleeves()[tuple(sleeve)]] if sleeve else None
    seed_pose = _look(draw, station, is_far, target_m)
    if station in LYING:
        error = _object_error(draw, seed_pose, station, hard)
    else:
        error = _mounted_error(draw, station, seed_pose, is_pair, is_far)
    return multiply(error, seed_pose), seed_pose


def camera_from_end_effector(station):
    """Of the left camera, and of the right one where it is alone."""
    return pose_of(rotation_about([0.0] * 3), [0.0, 0.0, STATIONS[station]["end_effector_m"]])


def _frame(name, camera_name, truth, seed, side_px):
    return {"id": name, "number": int(name[-6:]), "camera": camera_name,
            "camera_parameters": camera(camera_name, side_px), "camera_from_station": truth,
            "seed": seed}
