# SPDX-License-Identifier: Apache-2.0
"""Pinhole and Brown-Conrady cameras; the centre of the top-left pixel is (0, 0)."""

import math

import numpy as np

RENDER_DENSITY = 0.65  # pixels of the rendered picture to one of the sensor
MARGIN_px = 6


def distort(camera, x, y):
    """Normalized coordinates as the lens moves them (OpenCV's order k1 k2 p1 p2 k3)."""
    k1, k2, p1, p2, k3 = (list(camera.get("dist", [])) + [0.0] * 5)[:5]
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
    return (x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y)


def undistort(camera, x, y):
    """The inverse, by fixed-point iteration; to 1e-10 for the lenses made here."""
    u, v = x, y
    for _ in range(30 if camera.get("dist") else 0):
        dx, dy = distort(camera, u, v)
        u, v = u + (x - dx), v + (y - dy)
    return u, v


def project(camera, points):
    """Pixels (n x 2) of points in the camera frame (n x 3, m); those behind become NaN."""
    z = np.where(points[:, 2] > 1e-9, points[:, 2], np.nan)
    x, y = distort(camera, points[:, 0] / z, points[:, 1] / z)
    return np.column_stack([camera["fx"] * x + camera["cx"], camera["fy"] * y + camera["cy"]])


def rays(camera):
    """Normalized undistorted coordinates of every pixel: two arrays of the image's size."""
    u, v = np.meshgrid(np.arange(camera["width"]), np.arange(camera["height"]))
    return undistort(camera, (u - camera["cx"]) / camera["fx"], (v - camera["cy"]) / camera["fy"])


class Frame:
    """One picture to make: its camera, its pose, and the pinhole picture to render for it."""

    def __init__(self, plan, camera):
        self.id = plan["id"]
        self.camera = camera
        self.camera_from_station = np.array(plan["camera_from_station"])
        rotation, translation = self.camera_from_station[:3, :3], self.camera_from_station[:3, 3]
        self.place = -rotation.T @ translation
        x, y = rays(camera)
        self.reach = float(max(np.abs(x).max(), np.abs(y).max()))
        self.focal_px = RENDER_DENSITY * camera["fx"]
        self.side_px = 2 * (math.ceil(self.focal_px * self.reach) + MARGIN_px)

    def sees(self, points):
        """Whether any of the points (n x 3, m, station frame) is in the picture or nearly."""
        p = points @ self.camera_from_station[:3, :3].T + self.camera_from_station[:3, 3]
        front = p[:, 2] > 1e-3
        z = np.where(front, p[:, 2], 1.0)
        limit = 1.12 * self.reach
        return bool((front & (np.abs(p[:, 0] / z) < limit) & (np.abs(p[:, 1] / z) < limit)).any())

    def render_coordinates(self, x, y):
        """Where normalized coordinates lie in the rendered picture (pixel centres whole)."""
        middle = 0.5 * (self.side_px - 1)
        return self.focal_px * x + middle, self.focal_px * y + middle
