# SPDX-License-Identifier: Apache-2.0
"""Makes of the finished cases' records a dataset.json and the index files of a BOP data set."""

import json
import os

import plan
from scene.lattice import canister_sleeves

BOP_DEPTH_MM = 0.05


def replace_json(path, value):
    """Written aside and renamed, so that a reader never meets half a file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_name(path.name + ".part")
    draft.write_text(json.dumps(value, indent=1) + "\n")
    os.replace(draft, path)


def records(root):
    """The finished cases, in the order of their names."""
    return [json.loads(p.read_text()) for p in sorted((root / "cases").glob("*.json"))]


def write(root, seeds=1):
    """Both indices, with `seeds` cases of each picture in dataset.json; how many pictures."""
    known = records(root)
    if known:
        replace_json(root / "dataset.json", dataset(root, known, seeds))
        write_bop(root / "bop", known)
    return len(known)


def dataset(root, known, seeds=1):
    stations = sorted({r["plan"]["station"] for r in known})
    cameras = {r["frame"]["camera"]: r["frame"]["camera_parameters"] for r in known}
    return {"format": "boresight-dataset", "version": 1,
            "requirement": {"normal_mm": 0.4, "lateral_mm": 0.4, "rotation_deg": 0.25},
            "stations": {name: _station(root, name, known) for name in stations},
            "cameras": dict(sorted(cameras.items())),
            "cases": [case for r in known for case in _cases(r, seeds)]}


def parts_of(root, station):
    """Parts of a station's coarse mesh, one for each material, with its reflectance (written by
    `render_shot.py meshes`)."""
    parts = json.loads((root / station / "parts.json").read_text())
    return [{"mesh": f"{station}/{p['material']}.ply", "mesh_unit": "m", "albedo": p["albedo"]}
            for p in parts]


def equipment(station):
    """What a drawn state switches on: parts of dataset.json that are off."""
    made = {"gripper": {"mesh": f"{station}/gripper.ply", "frame": "CAMERA", "role": "occludes"}}
    if station == "bc":
        made["lid"] = {"mesh": "bc/lid.ply"}
    if station == "os":
        for i, (x, y) in enumerate(canister_sleeves().values()):
            made[f"tube_{i:02d}"] = {"mesh": "os/seated_tube.ply", "frame_from_mesh": [
                [1, 0, 0, 1e-3 * x], [0, 1, 0, 1e-3 * y], [0, 0, 1, 0], [0, 0, 0, 1]]}
    return [{"name": name, "mesh_unit": "m", "present": False, **part}
            for name, part in made.items()]


def state_of(record):
    """The parts that a picture shows, as `state` of its case."""
    drawn = record["plan"]["state"]
    filled = record["plan"]["filled_sleeves"] if record["plan"]["station"] == "os" else []
    return {name: "on" for name in [*drawn, *(f"tube_{i:02d}" for i in filled)]}


def _station(root, name, known):
    values = plan.STATIONS[name]
    parts = parts_of(root, name)
    if any("state" in r["plan"] for r in known if r["plan"]["station"] == name):
        parts += equipment(name)
    made = {"parts": parts, "feature_size_m": values["feature_size_m"],
            "uncertainty": values["declared"],
            "camera_from_end_effector": plan.camera_from_end_effector(name)}
    return made | {k: values[k] for k in ("symmetries",) if k in values}


def _case(record):
    frame, station = record["frame"], record["plan"]["station"]
    made = {"id": frame["id"], "station": station,
            "image": f"{station}/images/{frame['number']:06d}.png", "camera": frame["camera"],
            "seed": {"camera_from_station": frame["seed"]},
            "truth": {"camera_from_station": frame["camera_from_station"]}, "tags": frame["tags"]}
    for field in ("rig", "camera_from_end_effector"):
        if field in frame:
            made[field] = frame[field]
    uncertainty = plan.declared_uncertainty(station, frame["tags"])
    if uncertainty is not plan.STATIONS[station]["declared"]:
        made["uncertainty"] = uncertainty
    if "state" in record["plan"]:
        made["state"] = state_of(record)
    if "requirement" in plan.STATIONS[station]:
        made["requirement"] = plan.STATIONS[station]["requirement"]
    return made


def _cases(record, seeds):
    """The case of a picture, then one for each further seed. The two pictures of a rig have one
    seed, so further ones are not of a rig."""
    first = _case(record)
    cases = [first]
    for index in range(1, seeds):
        seed = plan.further_seed(record["plan"], record["frame"], index)
        case = {k: v for k, v in first.items() if k != "rig"}
        cases.append(case | {"id": f"{first['id']}-s{index:03d}",
                             "seed": {"camera_from_station": seed}})
    return cases


def write_bop(root, known):
    """A scene for each station; pictures, depth and masks are there already."""
    side_px = known[0]["frame"]["camera_parameters"]["width"]
    camera = plan.camera("left_pinhole", side_px)
    replace_json(root / "camera.json", {"depth_scale": BOP_DEPTH_MM, **{
        k: camera[k] for k in ("width", "height", "fx", "fy", "cx", "cy")}})
    targets = []
    for station, scene in plan.BOP_OBJECTS.items():
        cameras, truth, info = {}, {}, {}
        for record in (r for r in known if r["plan"]["station"] == station):
            key = str(record["frame"]["number"])
            cameras[key], truth[key] = _bop_camera(record), [_bop_pose(record, scene)]
            info[key] = [record["bop"]]
            targets.append({"im_id": int(key), "inst_count": 1, "obj_id": scene,
                            "scene_id": scene})
        if not cameras:
            continue
        folder = root / "test" / f"{scene:06d}"
        replace_json(folder / "scene_camera.json", cameras)
        replace_json(folder / "scene_gt.json", truth)
        replace_json(folder / "scene_gt_info.json", info)
    replace_json(root / "test_targets_bop19.json", targets)


def _bop_camera(record):
    c = record["frame"]["camera_parameters"]
    return {"cam_K": [c["fx"], 0.0, c["cx"], 0.0, c["fy"], c["cy"], 0.0, 0.0, 1.0],
            "depth_scale": BOP_DEPTH_MM}


def _bop_pose(record, number):
    pose = record["frame"]["camera_from_station"]
    return {"cam_R_m2c": [v for row in pose[:3] for v in row[:3]],
            "cam_t_m2c": [1e3 * row[3] for row in pose[:3]], "obj_id": number}
