# SPDX-License-Identifier: Apache-2.0
"""Tests of resources/synthetic: `generator_test.py Plan` (what is drawn) and `Pictures` (what is
rendered, against the projected mesh; killed and gone on with). Exit status 77: not run here."""

import json
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
GENERATOR = Path(__file__).resolve().parents[2] / "resources" / "synthetic"
sys.path.insert(0, str(GENERATOR))

import generate
import layout
import plan

SKIPPED = 77


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

    def test_truths_lie_in_the_declared_uncertainty(self):
        """p_true = Exp(r) p_seed + t, each component within what the station declares."""
        widest = {}
        for station, _, frame in self.frames(pairs=0.5):
            moved = plan.multiply(frame["camera_from_station"], plan.invert(frame["seed"]))
            angle = math.acos(min(1.0, 0.5 * (moved[0][0] + moved[1][1] + moved[2][2] - 1.0)))
            limits = plan.STATIONS[station]
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                turn = (moved[k][j] - moved[j][k]) * 0.5 * angle / math.sin(angle)
                self.assertLessEqual(abs(math.degrees(turn)), limits["declared_deg"][i])
                self.assertLessEqual(abs(moved[i][3]), limits["declared_m"][i])
                key = (station, i)
                widest[key] = max(widest.get(key, 0.0), abs(moved[i][3]) / limits["drawn_m"][i])
        self.assertGreater(min(widest.values()), 0.85)  # and fill it

    def test_station_is_in_the_middle_of_the_picture(self):
        for _, _, frame in self.frames():
            x, y, z = (row[3] for row in frame["camera_from_station"][:3])
            c = frame["camera_parameters"]
            self.assertGreater(z, 0.3)
            self.assertLess(math.hypot(x / z * c["fx"], y / z * c["fy"]), 0.35 * c["width"])

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
            self.assertEqual(sum(t in plan.HARD for t in frame["tags"]), 1)
        for _, _, frame in self.frames():
            self.assertNotIn("far", frame["tags"])
            self.assertNotIn("hard", frame["tags"])

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
            self.assertTrue((self.set / layout.dataset([record])["cases"][0]["image"]).exists())
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


if __name__ == "__main__":
    if sys.argv[1:2] == ["Pictures"]:
        if not os.environ.get("BORESIGHT_ALL") or shutil.which("blender") is None:
            print("skipped: needs Blender, and BORESIGHT_ALL (tests/run.sh --all)")
            raise SystemExit(SKIPPED)
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]], verbosity=2)
