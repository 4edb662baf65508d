# SPDX-License-Identifier: Apache-2.0
"""Tests of resources/synthetic: `generator_test.py Plan` (what is drawn) and `Pictures` (what is
rendered, against the projected mesh; killed and gone on with). Exit status 77: not run here."""

import json
import math
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib
from pathlib import Path

sys.dont_write_bytecode = True
GENERATOR = Path(__file__).resolve().parents[2] / "resources" / "synthetic"
sys.path.insert(0, str(GENERATOR))

import generate
import layout
import plan
from scene.lattice import canister_sleeves

SKIPPED = 77


# Table I of the paper, rows "Input": mean, standard deviation and maximum. The mean of the signed
# normal error is as good as zero, and what 2,000 draws leave of it.
TABLE_I = {"bc": {"normal_mm": (-0.095, 12.73, 19.92), "lateral_mm": (16.94, 8.853, 29.99),
                  "rotation_mrad": (48.86, 26.32, 86.92)},
           "os": {"normal_mm": (-0.054, 7.321, 11.45), "lateral_mm": (7.906, 4.131, 14.00),
                  "rotation_mrad": (17.13, 9.225, 30.47)}}


def errors_of(frame, station):
    """Signed normal mm, lateral mm and out-of-plane mrad of a seed, from first principles: the end
    effector under E = camera_true_from_camera_seed, in the true camera's axes."""
    e = plan.multiply(frame["camera_from_station"], plan.invert(frame["seed"]))
    tool = frame.get("camera_from_end_effector") or plan.camera_from_end_effector(station)
    p = [tool[i][3] for i in range(3)]
    d = [sum(e[i][k] * p[k] for k in range(3)) + e[i][3] - p[i] for i in range(3)]
    # Sine from the cross product of z and R z: the angle itself where cosines have no digits.
    tilt = math.asin(min(1.0, math.hypot(e[0][2], e[1][2])))
    return 1e3 * d[2], 1e3 * math.hypot(d[0], d[1]), 1e3 * tilt


def statistics(values):
    mean = sum(values) / len(values)
    spread = math.sqrt(sum((v - mean) ** 2 for v in values) / len(values))
    return mean, spread, max(abs(v) for v in values)


def vertices_of(path):
    """Of a binary PLY of the generator, metres."""
    data = path.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    count = int(head.split(b"element vertex ")[1].split()[0])
    return [struct.unpack_from("<3f", body, 12 * i) for i in range(count)]


def gray_png(path):
    """Pixels, row by row, of an 8-bit PNG of the generator (differences to the left neighbour)."""
    data, at, body, width = path.read_bytes(), 8, b"", 0
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width = struct.unpack(">I", data[at + 8:at + 12])[0]
        elif kind == b"IDAT":
            body += data[at + 8:at + 8 + length]
        at += 12 + length
    pixels, rows = [], zlib.decompress(body)
    for start in range(0, len(rows), width + 1):
        value = 0
        for step in rows[start + 1:start + 1 + width]:
            value = (value + step) & 255
            pixels.append(value)
    return pixels


class Plan(unittest.TestCase):
    def frames(self, **options):
        for station in plan.STATIONS:
            for shot in plan.shots(7, station, 200, **options):
                for frame in shot["frames"]:
                    yield station, shot, frame

    def test_larger_set_begins_with_the_smaller(self):
        for station in plan.STATIONS:
            small = [f for s in plan.shots(3, station, 9) for f in s["frames"]]
            large = [f for s in plan.shots(3, station, 30) for f in s["frames"]]
            for a, b in zip(small, large):
                self.assertEqual((a["id"], a["camera"], a["seed"], a["camera_from_station"]),
                                 (b["id"], b["camera"], b["seed"], b["camera_from_station"]))

    def test_cases_are_numbered_without_gaps(self):
        for station in plan.STATIONS:
            ids = [f["id"] for s in plan.shots(1, station, 25) for f in s["frames"]]
            self.assertEqual(ids, [f"{station}-{i:06d}" for i in range(25)])

    def test_input_errors_are_distributed_as_in_the_papers_table(self):
        for station, rows in TABLE_I.items():
            for pairs in (0.25, 1.0):
                shots = plan.shots(1, station, 2000, pairs=pairs)
                errors = list(zip(*(errors_of(f, station) for s in shots for f in s["frames"])))
                for (row, published), values in zip(rows.items(), errors):
                    self.assertEqual(len(values), 2000)
                    for name, ours, theirs in zip(("mean", "std", "max"), statistics(values),
                                                  published):
                        # Of a mean near zero: four standard errors.
                        signed = row == "normal_mm" and name == "mean"
                        limit = 4.0 * published[1] / 2000 ** 0.5 if signed else 0.1 * theirs
                        self.assertLess(abs(ours - theirs), limit, (station, pairs, row, name, ours))

    def test_further_seeds_are_distributed_as_in_the_papers_table(self):
        for station, rows in TABLE_I.items():
            frames = [(s, f) for s in plan.shots(1, station, 10) for f in s["frames"]]
            seeded = [dict(f, seed=plan.further_seed(s, f, i)) for s, f in frames
                      for i in range(1, 201)]
            errors = list(zip(*(errors_of(f, station) for f in seeded)))
            for (row, published), values in zip(rows.items(), errors):
                for name, ours, theirs in zip(("mean", "std", "max"), statistics(values),
                                              published):
                    signed = row == "normal_mm" and name == "mean"
                    limit = 4.0 * published[1] / 2000 ** 0.5 if signed else 0.1 * theirs
                    self.assertLess(abs(ours - theirs), limit, (station, row, name, ours))

    def test_further_seeds_lie_in_the_declared_uncertainty_and_repeat(self):
        for station in plan.STATIONS:
            for options in ({}, {"far": 1.0}):
                for shot in plan.shots(2, station, 3, **options):
                    for frame in shot["frames"]:
                        seed = plan.further_seed(shot, frame, 1)
                        self.assertEqual(seed, plan.further_seed(shot, frame, 1))
                        self.assertNotEqual(seed, plan.further_seed(shot, frame, 2))
                        declared = plan.declared_uncertainty(station, frame["tags"])
                        error = plan.multiply(frame["camera_from_station"], plan.invert(seed))
                        self.assertTrue(plan.is_declared(
                            error, declared, plan.pivot_of(station, declared, seed)), station)

    def test_truths_lie_in_the_declared_uncertainty(self):
        """p_true = Exp(r) (p_seed - c) + c + t, each component within what the case declares."""
        widest = {}
        for options in ({"pairs": 1.0}, {"pairs": 0.0}, {"pairs": 0.5, "far": 1.0},
                        {"pairs": 0.5, "hard": 1.0}):
            for station, _, frame in self.frames(**options):
                declared = plan.declared_uncertainty(station, frame["tags"])
                moved = plan.multiply(frame["camera_from_station"], plan.invert(frame["seed"]))
                angle = math.acos(min(1.0, 0.5 * (moved[0][0] + moved[1][1] + moved[2][2] - 1.0)))
                centre = plan.STATIONS[station]["centre_m"]
                pivots = [[sum(frame[k][i][j] * centre[j] for j in range(3)) + frame[k][i][3]
                           for i in range(3)] for k in ("seed", "camera_from_station")]
                if declared["pivot"] == "camera":
                    pivots = [[0.0] * 3, [moved[i][3] for i in range(3)]]
                for i in range(3):
                    j, k = (i + 1) % 3, (i + 2) % 3
                    turn = math.degrees((moved[k][j] - moved[j][k]) * 0.5 * angle / math.sin(angle))
                    move = pivots[1][i] - pivots[0][i]
                    self.assertLessEqual(abs(turn), declared["rotation_deg"][i])
                    self.assertLessEqual(abs(move), declared["translation_m"][i])
                    for key, share in ((("deg", i), turn / declared["rotation_deg"][i]),
                                       (("m", i), move / declared["translation_m"][i])):
                        key = (station, *key, *(t for t in frame["tags"] if t == "far"))
                        widest[key] = max(widest.get(key, 0.0), abs(share))
        # And fill it; for bc it is the paper's range.
        self.assertGreater(min(v for k, v in widest.items() if k[0] != "bc"), 0.7)
        self.assertGreater(min(widest.values()), 2 / 3)

    def test_canister_view_and_end_effector_are_over_a_random_sleeve(self):
        seen = set()
        for shot in plan.shots(7, "os", 400):
            sleeve = tuple(shot["target_sleeve"])
            seen.add(sleeve)
            x, y = canister_sleeves()[sleeve]
            pose = shot["frames"][0]["seed"]
            at = [sum(pose[i][k] * v for k, v in enumerate((1e-3 * x, 1e-3 * y, 0.0))) + pose[i][3]
                  for i in range(3)]
            self.assertLess(math.hypot(at[0], at[1]), 1e-9)  # on the axis, as the end effector is
            self.assertLess(abs(at[2] - 0.37), 0.045)
        self.assertEqual(seen, set(canister_sleeves()))

    def test_tags_tell_sleeves_at_the_rim(self):
        for shot in plan.shots(1, "os", 60):
            x, y = canister_sleeves()[tuple(shot["target_sleeve"])]
            expected = "sleeve_rim" if math.hypot(x, y) > 80.0 else "sleeve_inner"
            self.assertIn(expected, shot["tags"])
        self.assertFalse(any("sleeve" in t for s in plan.shots(1, "bc", 20) for t in s["tags"]))

    def test_sleeves_are_a_pitch_of_33_mm_apart(self):
        places = list(canister_sleeves().values())
        for a in places:
            nearest = min(math.dist(a, b) for b in places if b != a)
            self.assertAlmostEqual(nearest, 33.0, places=9)

    def test_transparent_object_and_its_opaque_copy_are_drawn_alike(self):
        glass, opaque = (plan.shots(5, s, 30) for s in ("vial", "vial_opaque"))
        for a, b in zip(glass, opaque):
            for key in a.keys() - {"shot", "station", "tags", "frames"}:
                self.assertEqual(a[key], b[key], key)
            self.assertEqual([t for t in a["tags"] if t != "transparent"], b["tags"])
            for f, g in zip(a["frames"], b["frames"]):
                for key in ("camera", "camera_from_station", "seed"):
                    self.assertEqual(f[key], g[key])

    def test_sun_is_above_the_ground_on_which_objects_lie(self):
        for station, shot, _ in self.frames():
            if station in plan.LYING:
                up, sun = shot["up"], shot["towards_sun"]
                self.assertGreater(sum(a * b for a, b in zip(up, sun)), math.sin(math.radians(3.0)))

    def test_station_is_in_the_middle_of_the_picture(self):
        for station, _, frame in self.frames():
            if station == "os":  # a sleeve is in the middle
                continue
            x, y, z = (row[3] for row in frame["camera_from_station"][:3])
            c = frame["camera_parameters"]
            self.assertGreater(z, 0.25)
            self.assertLess(math.hypot(x / z * c["fx"], y / z * c["fy"]), 0.42 * c["width"])

    def test_pairs_are_one_rig(self):
        count = 0
        for _, shot, frame in self.frames(pairs=1.0):
            if len(shot["frames"]) < 2:
                continue
            left, right = shot["frames"]
            self.assertEqual(left["rig"]["id"], right["rig"]["id"])
            both = [plan.multiply(plan.invert(f["rig"]["camera_from_rig"]), f[k])
                    for k in ("camera_from_station", "seed") for f in (left, right)]
            for a, b in (both[:2], both[2:]):
                for row_a, row_b in zip(a, b):
                    for u, v in zip(row_a, row_b):
                        self.assertAlmostEqual(u, v, places=12)
            count += 1
        self.assertGreater(count, 100)

    def test_far_and_hard_are_told_by_tags(self):
        for _, _, frame in self.frames(far=1.0, hard=1.0):
            self.assertIn("far", frame["tags"])
            self.assertGreater(frame["camera_from_station"][2][3], 0.9)
            self.assertEqual(sum(t.startswith("hard_") for t in frame["tags"]), 1)
        for _, _, frame in self.frames():
            self.assertNotIn("far", frame["tags"])
            self.assertNotIn("hard", frame["tags"])

    def test_drawn_state_changes_nothing_else(self):
        for station in ("bc", "os"):
            plain = plan.shots(3, station, 30, pairs=0.0)
            drawn = plan.shots(3, station, 30, pairs=0.0, state=True)
            names = set()
            for before, after in zip(plain, drawn):
                state = after.pop("state")
                names.update(state)
                for shot in (before, after):
                    shot["tags"] = [t for t in shot["tags"] if not t.startswith("state_")]
                    for frame in shot["frames"]:
                        frame["tags"] = shot["tags"]
                self.assertEqual(before, after)
            self.assertEqual(names, {"gripper", "lid"} if station == "bc" else {"gripper"})

    def test_sun_behind_the_camera_changes_nothing_else(self):
        for station in ("bc", "os", "mug"):
            for before, after in zip(plan.shots(3, station, 30, pairs=0.0),
                                     plan.shots(3, station, 30, pairs=0.0, sun_behind=True)):
                sun = after.pop("towards_sun")
                before.pop("towards_sun")
                self.assertAlmostEqual(math.hypot(*sun), 1.0)
                pose = after["frames"][0]["camera_from_station"]
                behind = -sum(pose[2][i] * sun[i] for i in range(3))
                angle_deg = math.degrees(math.acos(behind))
                self.assertTrue(15.0 <= angle_deg <= 35.0, angle_deg)
                self.assertIn("sun_camera", after["tags"])
                for shot in before, after:
                    for each in (shot, *shot["frames"]):
                        each["tags"] = [t for t in each["tags"] if not t.startswith("sun_")]
                self.assertEqual(before, after)

    def test_state_names_parts_of_the_station(self):
        for station in ("bc", "os"):
            parts = layout.equipment(station)
            self.assertFalse(any(part["present"] for part in parts))
            record = {"plan": {"station": station, "filled_sleeves": [0, 5],
                               "state": ["gripper"] + ["lid"] * (station == "bc")}}
            state = layout.state_of(record)
            self.assertLessEqual(set(state), {part["name"] for part in parts})
            self.assertEqual("tube_05" in state, station == "os")

    def test_scaled_camera_sees_the_same(self):
        full, half = plan.camera("left_barrel"), plan.camera("left_barrel", 1024)
        for x in (-0.3, 0.0, 0.2):
            u = full["fx"] * x + full["cx"]
            self.assertAlmostEqual(half["fx"] * x + half["cx"], (u + 0.5) / 2.0 - 0.5, places=9)


class Pictures(unittest.TestCase):
    """One small set, rendered once."""

    @classmethod
    def setUpClass(cls):
        cls.root = Path(tempfile.mkdtemp(prefix="boresight_synthetic_"))
        cls.set = cls.root / "set"

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root)

    def command(self, *more):
        return [sys.executable, str(GENERATOR / "generate.py"), "--out", str(self.set), "--cases",
                "1", "--seed", "1", "--pairs", "0", "--size", "1024", *more]

    def measure(self, *more):
        words = ["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                 str(GENERATOR / "edge_offset.py"), "--", str(self.set), *more]
        return subprocess.run(words, env=generate.environment("blender"), capture_output=True,
                              text=True)

    def finished(self):
        return {p.name: p.stat().st_mtime_ns for p in self.set.rglob("*.png")
                if "unfinished" not in p.parts}

    def test_1_killed_run_leaves_whole_cases_only_and_is_gone_on_with(self):
        process = subprocess.Popen(self.command(), start_new_session=True)
        cases = self.set / "cases"
        deadline = time.monotonic() + 1500.0
        while not (cases.exists() and any(cases.glob("*.json"))):
            self.assertIsNone(process.poll(), "ended without a case")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.2)
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        before = self.finished()
        subprocess.run(self.command(), check=True)
        after = self.finished()
        for record in layout.records(self.set):
            self.assertTrue((self.set / layout.dataset(self.set, [record])["cases"][0]["image"]).exists())
        first = f"{layout.records(self.set)[0]['frame']['number']:06d}.png"
        self.assertIn(first, before)
        data = json.loads((self.set / "dataset.json").read_text())
        self.assertEqual([c["id"] for c in data["cases"]], ["bc-000000", "os-000000"])
        self.assertFalse((self.set / "unfinished").exists())
        subprocess.run(self.command(), check=True)
        self.assertEqual(self.finished(), after)  # nothing is made twice

    def test_2_picture_edges_lie_on_the_projected_mesh(self):
        result = self.measure()
        self.assertEqual(result.returncode, 0, result.stdout[-2000:])
        self.assertIn("all 2: median", result.stdout)

    def test_3_moved_projection_is_found_out(self):
        self.assertNotEqual(self.measure("--shift-px", "0.2", "0").returncode, 0)

    def test_6_meshes_have_the_stated_centre_and_an_albedo_for_each_part(self):
        """`centre_m` is the pivot of the declared boxes: the middle of the matched parts."""
        for station, values in plan.STATIONS.items():
            parts = layout.parts_of(self.set, station)
            self.assertTrue(parts)
            points = []
            for part in parts:
                self.assertTrue(0.0 < part["albedo"] < 1.0)
                points += vertices_of(self.set / part["mesh"])
            for axis, stated in enumerate(values["centre_m"]):
                values_m = [p[axis] for p in points]
                self.assertAlmostEqual(0.5 * (min(values_m) + max(values_m)), stated, delta=1e-5)

    def test_4_bop_says_how_much_of_the_station_is_seen(self):
        for scene in ("000001", "000002"):
            folder = self.set / "bop" / "test" / scene
            info = json.loads((folder / "scene_gt_info.json").read_text())["0"][0]
            self.assertTrue((folder / "mask" / "000000_000000.png").exists())
            self.assertLessEqual(info["px_count_visib"], info["px_count_all"])
            self.assertGreater(info["visib_fract"], 0.8)  # nothing stands before it
            self.assertAlmostEqual(info["visib_fract"],
                                   info["px_count_visib"] / info["px_count_all"])
            x, y, width, height = info["bbox_visib"]
            whole = info["bbox_obj"]
            self.assertTrue(whole[0] <= x and whole[1] <= y)
            self.assertTrue(x + width <= whole[0] + whole[2] and y + height <= whole[1] + whole[3])

    def test_5_other_options_are_refused(self):
        result = subprocess.run(self.command("--far"), capture_output=True, text=True)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("holds a set made with", result.stderr)

    def test_7_glass_and_its_opaque_copy_differ_in_the_object_and_its_shadow_alone(self):
        root = self.root / "copies"
        subprocess.run([sys.executable, str(GENERATOR / "generate.py"), "--out", str(root), "--cases",
                        "1", "--seed", "3", "--pairs", "0", "--size", "384", "--stations",
                        "vial,vial_opaque"], check=True)
        glass, opaque = (gray_png(root / s / "images/000000.png") for s in ("vial", "vial_opaque"))
        mask = gray_png(root / "bop/test/000005/mask/000000_000000.png")
        apart = [[], []]
        for a, b, inside in zip(glass, opaque, mask):
            apart[inside > 0].append(abs(a - b))
        self.assertGreater(len(apart[1]), 2000)
        self.assertGreater(sum(apart[1]) / len(apart[1]), 10.0)
        self.assertLess(sum(d > 12 for d in apart[0]) / len(apart[0]), 0.1)


if __name__ == "__main__":
    if sys.argv[1:2] == ["Pictures"]:
        if not os.environ.get("BORESIGHT_ALL") or shutil.which("blender") is None:
            print("skipped: needs Blender, and BORESIGHT_ALL (tests/run.sh --all)")
            raise SystemExit(SKIPPED)
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]], verbosity=2)
