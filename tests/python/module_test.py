#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The Python module against the program whs, and against arithmetic of its own."""

import gc
import json
import os
import subprocess
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

import boresight

EXAMPLES = Path(os.environ["EXAMPLES"])
WHS = os.environ["WHS"]


def example(station="bc"):
    folder = EXAMPLES / station
    return boresight.read_case(image=folder / "image.png", mesh=folder / "model.ply", mesh_unit="m",
                               seed=folder / "seed.json", camera=folder / "camera.json",
                               truth=folder / "truth.json")


def project(camera, camera_from_station, points):
    """Pinhole and Brown-Conrady with five coefficients."""
    p = points @ camera_from_station[:3, :3].T + camera_from_station[:3, 3]
    x, y = p[:, 0] / p[:, 2], p[:, 1] / p[:, 2]
    k1, k2, p1, p2, k3 = (list(camera.get("dist", [])) + [0.0] * 5)[:5]
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return np.stack([camera["fx"] * u + camera["cx"], camera["fy"] * v + camera["cy"]], axis=1)


class Module(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.case = example()
        cls.run_ = boresight.localize(cls.case)

    def test_run_has_the_digest_of_whs(self):
        folder = EXAMPLES / "bc"
        with tempfile.TemporaryDirectory() as place:
            out = Path(place) / "result.json"
            subprocess.run([WHS, "localize", "--image", folder / "image.png", "--mesh",
                            folder / "model.ply", "--mesh-unit", "m", "--seed", folder / "seed.json",
                            "--camera", folder / "camera.json", "--out", out], check=True,
                           capture_output=True)
            result = json.loads(out.read_text())
        self.assertEqual(self.run_.digest, result["provenance"]["digest"])
        self.assertTrue(self.run_.converged)
        np.testing.assert_allclose(self.run_.camera_from_station, result["camera_from_station"],
                                   atol=1e-15)
        np.testing.assert_array_equal(self.run_.covariance, result["covariance"])

    def test_pose_is_near_the_truth(self):
        error = self.run_.camera_from_station @ np.linalg.inv(self.case.camera_from_station_truth)
        self.assertLess(np.linalg.norm(error[:3, 3]), 1e-3)

    def test_arrays_have_the_shapes_of_the_image(self):
        height, width = self.case.image.shape
        self.assertEqual(self.run_.edges(0).shape, (height, width))
        self.assertGreater(self.run_.edges(0).sum(), 1000)
        matching = next(i for i in self.run_.iterations if i["kind"] == "match")
        self.assertEqual(len(matching["templates"]["x"]), len(matching["matches"]["x"]))
        self.assertEqual(len(matching["matches"]["pixel"]), len(matching["matches"]["inlier"]))
        with self.assertRaises(IndexError):
            self.run_.edges(99)

    def test_rendered_edges_lie_on_the_projected_mesh(self):
        render = boresight.render_edges(self.case, self.case.camera_from_station_truth)
        self.assertTrue(render["edges"][render["y"], render["x"]].all())
        seen = project(self.case.camera, self.case.camera_from_station_truth,
                       self.case.vertices_in_station_m.astype(float))
        self.assertGreater(render["x"].min(), seen[:, 0].min() - 2)
        self.assertLess(render["x"].max(), seen[:, 0].max() + 2)

    def test_pnp_recovers_a_pose(self):
        points = np.random.default_rng(1).uniform(-0.05, 0.05, (30, 3))
        pose = self.case.camera_from_station_truth
        pixels = project(self.case.camera, pose, points)
        solved = boresight.solve_pnp(points, pixels, EXAMPLES / "bc" / "camera.json")
        np.testing.assert_allclose(solved["camera_from_station"], pose, atol=1e-8)
        self.assertLess(solved["rms_px"], 1e-6)
        with self.assertRaises(ValueError):
            boresight.solve_pnp(points[:2], pixels[:2], EXAMPLES / "bc" / "camera.json")
        for sigma_px in (0, -1, float("nan"), float("inf")):
            with self.assertRaisesRegex(ValueError, "sigma_px must be"):
                boresight.solve_pnp(points, pixels, EXAMPLES / "bc" / "camera.json", sigma_px)

    def test_checks_are_those_of_review(self):
        checks = {check["id"]: check for check in boresight.check(self.run_)}
        self.assertEqual(checks["converged"]["state"], "passed")

    def test_options_are_checked(self):
        with self.assertRaises(ValueError):
            boresight.localize(self.case, options={"loop.nothing": 1})
        with self.assertRaises(ValueError):
            boresight.localize(self.case, profile="none")
        stopped = boresight.localize(self.case, options={"loop.max_iterations": 1})
        self.assertNotEqual(stopped.digest, self.run_.digest)

    def test_wrong_shapes_and_values_raise(self):
        pose = self.case.camera_from_station_truth
        for wrong in (pose[:3], pose[:3, :3], pose.ravel(), pose * 2.0, pose * np.nan,
                      np.diag([1.0, 1.0, -1.0, 1.0]), np.stack([pose, pose]), "pose"):
            with self.assertRaises((TypeError, ValueError)):
                boresight.render_edges(self.case, wrong)
        camera = EXAMPLES / "bc" / "camera.json"
        points, pixels = np.zeros((8, 3)), np.zeros((8, 2))
        for a, b in ((points.T, pixels), (points, pixels.T), (points[:7], pixels),
                     (points.ravel(), pixels), (points[:, :2], pixels), (points, pixels[:, :1]),
                     (points * np.nan, pixels), (points, pixels + np.inf), (points, pixels),
                     (np.zeros((0, 3)), np.zeros((0, 2)))):
            with self.assertRaises((TypeError, ValueError)):
                boresight.solve_pnp(a, b, camera)

    def test_threads_share_a_case(self):
        with ThreadPoolExecutor(2) as pool:
            digests = list(pool.map(lambda _: boresight.localize(self.case).digest, range(2)))
        self.assertEqual(set(digests), {self.run_.digest})

    def test_arrays_outlive_what_they_were_taken_from(self):
        case = example("os")
        image, vertices = case.image, case.vertices_in_station_m
        run = boresight.localize(case, options={"loop.max_iterations": 1})
        del case
        gc.collect()
        iterations, edges = run.iterations, run.edges(0)
        again = boresight.localize(self.case, options={"loop.max_iterations": 1})
        del run
        gc.collect()
        whole = example("os")
        np.testing.assert_array_equal(image, whole.image)
        np.testing.assert_array_equal(vertices, whole.vertices_in_station_m)
        self.assertGreater(len(iterations), 0)
        self.assertEqual(edges.shape, image.shape)
        self.assertGreater(len(again.iterations), 0)

    def test_wrong_files_raise(self):
        with self.assertRaises(boresight.InputError) as raised:
            boresight.read_case(image="/nowhere.png", mesh=EXAMPLES / "bc" / "model.ply",
                                mesh_unit="m", seed=EXAMPLES / "bc" / "seed.json",
                                camera=EXAMPLES / "bc" / "camera.json")
        self.assertIn("/nowhere.png", str(raised.exception))

    def test_session_is_written_and_read(self):
        with tempfile.TemporaryDirectory() as place:
            file = Path(place) / "s.boresight.json"
            boresight.new_session(file, [self.case])
            session = boresight.read_session(file)
            self.assertEqual(session.case_ids, [self.case.id])
            again = boresight.localize(session.case(self.case.id))
            self.assertEqual(again.digest, self.run_.digest)

    def test_case_of_a_session_runs_with_its_options(self):
        with tempfile.TemporaryDirectory() as place:
            file = Path(place) / "s.boresight.json"
            boresight.new_session(file, [self.case])
            text = json.loads(file.read_text())
            text["options"] = {"loop.max_iterations": 1}
            file.write_text(json.dumps(text))
            case = boresight.read_session(file).case(self.case.id)
            few = boresight.localize(self.case, options={"loop.max_iterations": 1})
            self.assertEqual(boresight.localize(case).digest, few.digest)
            self.assertEqual(boresight.localize(case, profile="default").digest,
                             self.run_.digest)

    def test_new_session_keeps_cases_of_one_name(self):
        with tempfile.TemporaryDirectory() as place:
            session = boresight.new_session(Path(place) / "s.boresight.json",
                                            [self.case, self.case])
            self.assertEqual(len(set(session.case_ids)), 2)


class Notebook(unittest.TestCase):
    def test_notebook_draws_its_figure(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("no matplotlib")
        matplotlib.use("Agg")
        notebook = Path(os.environ["NOTEBOOKS"]) / "error_strips.ipynb"
        cells = json.loads(notebook.read_text())["cells"]
        script = "\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "code")
        with tempfile.TemporaryDirectory() as place:
            os.environ["RESULTS"] = str(Path(place) / "example.sqlite")
            os.environ["DATASET"] = str(EXAMPLES / "dataset.json")
            os.environ["PATH"] = str(Path(WHS).parent) + os.pathsep + os.environ["PATH"]
            exec(compile(script, str(notebook), "exec"), {})
            self.assertGreater((Path(place) / "example.png").stat().st_size, 10000)


if __name__ == "__main__":
    unittest.main()
