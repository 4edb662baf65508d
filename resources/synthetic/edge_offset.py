# SPDX-License-Identifier: Apache-2.0
"""How far the edges in the pictures of a data set lie from its meshes' edges under the true poses.

    blender -b --python-exit-code 1 --python edge_offset.py -- DIR [--shift-px DX DY] [--case ID ...]

Every visible crease and outline of the mesh is projected through the case's camera and sampled;
along its normal the nearest clear edge of the picture is looked for. Printed, and judged, are per
data set the median of the distances and, per case, the shift of the picture that explains them
best. `--shift-px` moves the projection, so that one can see the test fail.
"""

import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.dont_write_bytecode = True

import numpy as np

from imaging import cameras, pixels

CREASE_deg = 30.0
STEP_px = 6.0  # between samples along an edge
REACH_px = 3.0  # how far along the normal an edge of the picture is looked for
MIN_CONTRAST = 14.0  # grey values across an edge of the picture
DEPTH_SCALE = 0.25  # of the depth picture that says what is hidden
UNJUDGED = {"hard", "transparent"}  # tags: hidden or blurred edges, edges seen through glass
MAX_MEDIAN_px, MAX_SHIFT_px = 0.35, 0.05


def read_mesh(path):
    """Vertices (m) and triangles of a binary PLY of this generator."""
    data = path.read_bytes()
    start = data.index(b"end_header\n") + 11
    words = data[:start].decode().split()
    vertex_count = int(words[words.index("vertex") + 1])
    vertices = np.frombuffer(data, "<f4", 3 * vertex_count, start).reshape(-1, 3)
    faces = np.frombuffer(data[start + 12 * vertex_count:], [("n", "u1"), ("v", "<i4", 3)])
    return vertices.astype(np.float64), faces["v"].astype(np.int64)


def read_station(root, station):
    """All parts of a station as one mesh."""
    vertices, triangles = [], []
    for part in station["parts"]:
        points, faces = read_mesh(root / part["mesh"])
        triangles.append(faces + sum(len(v) for v in vertices))
        vertices.append(points)
    return np.vstack(vertices), np.vstack(triangles)


def edges_of(vertices, triangles):
    """Edges (k x 2) and the triangles on their sides (k x 2, the same twice at a border)."""
    edges = np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    owner = np.tile(np.arange(len(triangles)), 3)
    keys = np.sort(edges, axis=1)
    order = np.lexsort((keys[:, 1], keys[:, 0]))
    keys, owner = keys[order], owner[order]
    first = np.flatnonzero(np.r_[True, (keys[1:] != keys[:-1]).any(1)])
    last = np.r_[first[1:], len(keys)] - 1
    return keys[first], np.column_stack([owner[first], owner[last]])


def facing(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-15)
    return normal, (normal * a).sum(1) < 0.0  # towards the camera


def seen_edges(points, triangles):
    """Edges that may show: creases with a side towards the camera, and outlines."""
    edges, sides = edges_of(points, triangles)
    normal, front = facing(points, triangles)
    bent = (normal[sides[:, 0]] * normal[sides[:, 1]]).sum(1) < np.cos(np.radians(CREASE_deg))
    outline = (front[sides[:, 0]] != front[sides[:, 1]]) | (sides[:, 0] == sides[:, 1])
    visible = front[sides].any(1) & (bent | outline)
    return edges[visible]


def depth_picture(points, triangles, camera):
    """Nearest depth (m) of the mesh in a coarse pinhole picture of the same view."""
    side = int(camera["width"] * DEPTH_SCALE * 1.1)
    focal = camera["fx"] * DEPTH_SCALE
    xy = points[:, :2] / points[:, 2:] * focal + 0.5 * side
    nearest = np.full((side, side), np.inf)
    for triangle in triangles[facing(points, triangles)[1]]:
        p, z = xy[triangle], points[triangle, 2]
        low = np.maximum(np.floor(p.min(0)).astype(int), 0)
        high = np.minimum(np.ceil(p.max(0)).astype(int) + 1, side)
        if (low >= high).any():
            continue
        x, y = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
        (ax, ay), (bx, by), (cx, cy) = p
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if abs(area) < 1e-9:
            continue
        u = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
        v = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
        inside = (u >= 0) & (v >= 0) & (u + v <= 1)
        depth = 1.0 / (u / z[0] + v / z[1] + (1 - u - v) / z[2] + 1e-12)
        block = nearest[low[1]:high[1], low[0]:high[0]]
        block[inside] = np.minimum(block[inside], depth[inside])
    return nearest, focal


def unhidden(samples, nearest, focal):
    """Which points (n x 3) have nothing of the mesh more than 0.6 mm in front of them."""
    side = len(nearest)
    at = np.rint(samples[:, :2] / samples[:, 2:] * focal + 0.5 * side).astype(int)
    made = np.ones(len(samples), dtype=bool)
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            x, y = np.clip(at[:, 0] + dx, 0, side - 1), np.clip(at[:, 1] + dy, 0, side - 1)
            made &= nearest[y, x] > samples[:, 2] - 0.0006
    return made


def samples_of(points, edges, camera):
    """Points along the edges (n x 3), their pixels and unit normals in the picture (n x 2)."""
    ends = [cameras.project(camera, points[edges[:, i]]) for i in (0, 1)]
    counts = np.maximum(1, (np.linalg.norm(ends[1] - ends[0], axis=1) / STEP_px)).astype(int)
    index = np.repeat(np.arange(len(edges)), counts)
    within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    share = ((within + 0.5) / counts[index])[:, None]
    a, b = points[edges[index, 0]], points[edges[index, 1]]
    middle = a + share * (b - a)
    at = cameras.project(camera, middle)
    along = cameras.project(camera, middle + 1e-3 * (b - a)) - at
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
    return middle, at, np.column_stack([-along[:, 1], along[:, 0]])


def offsets(image, at, normal):
    """Signed distance (px) along the normal to the nearest clear edge; NaN where there is none."""
    step = 0.25
    along = np.arange(-REACH_px - 1.0, REACH_px + 1.0 + 0.5 * step, step)
    profile = pixels.sample(image, at[:, :1] + along * normal[:, :1],
                            at[:, 1:] + along * normal[:, 1:])
    slope = np.abs(profile[:, 4:] - profile[:, :-4])  # across one pixel
    middle = along[2:-2]
    peak = np.zeros_like(slope, dtype=bool)
    peak[:, 1:-1] = (slope[:, 1:-1] >= slope[:, :-2]) & (slope[:, 1:-1] > slope[:, 2:])
    peak &= (slope > MIN_CONTRAST) & (np.abs(middle) <= REACH_px)
    # A peak next to one twice as high is its foot.
    peak &= slope > 0.5 * slope.max(1, keepdims=True)
    distance = np.where(peak, np.abs(middle), np.inf)
    best = distance.argmin(1)
    rows = np.arange(len(best))
    inner = np.clip(best, 1, slope.shape[1] - 2)
    left, centre, right = (slope[rows, inner + i] for i in (-1, 0, 1))
    bend = left - 2 * centre + right
    fine = np.where(np.abs(bend) > 1e-6, 0.5 * (left - right) / np.where(bend == 0, 1, bend), 0)
    found = middle[inner] + step * fine
    return np.where(np.isfinite(distance[rows, best]), found, np.nan)


def shift_of(offset, normal):
    """The shift (px) of the picture that explains the offsets best; far ones count less."""
    weight = np.ones(len(offset))
    for _ in range(20):
        a = normal * weight[:, None]
        shift = np.linalg.solve(a.T @ normal, a.T @ offset)
        left = offset - normal @ shift
        weight = 1.0 / (1.0 + (left / 0.3) ** 2) ** 2
    return shift


def measure(case, mesh, camera, image, shift_px):
    vertices, triangles = mesh
    pose = np.array(case["truth"]["camera_from_station"])
    points = vertices @ pose[:3, :3].T + pose[:3, 3]
    samples, at, normal = samples_of(points, seen_edges(points, triangles), camera)
    keep = unhidden(samples, *depth_picture(points, triangles, camera))
    keep &= ((at > 8) & (at < [camera["width"] - 9, camera["height"] - 9])).all(1)
    at, normal = at[keep] + shift_px, normal[keep]
    found = offsets(pixels.blur(image.astype(np.float32), 0.7), at, normal)
    clear = np.isfinite(found)
    return found[clear], normal[clear], int(keep.sum())


def main(arguments):
    shift_px = np.zeros(2)
    if "--shift-px" in arguments:
        i = arguments.index("--shift-px")
        shift_px = np.array([float(v) for v in arguments[i + 1:i + 3]])
        del arguments[i:i + 3]
    root = Path(arguments[0])
    wanted = [a for a in arguments[1:] if a != "--case"]
    data = json.loads((root / "dataset.json").read_text())
    meshes = {k: read_station(root, s) for k, s in data["stations"].items()}
    every, shifts = [], []
    for case in data["cases"]:
        if (wanted and case["id"] not in wanted) or UNJUDGED & set(case["tags"]):
            continue
        camera = data["cameras"][case["camera"]]
        offset, normal, count = measure(case, meshes[case["station"]], camera,
                                        pixels.read_png(root / case["image"]), shift_px)
        shift = shift_of(offset, normal)
        every.append(np.abs(offset))
        shifts.append(shift)
        print(f"{case['id']}: {len(offset)} of {count} samples at an edge, median "
              f"{np.median(every[-1]):.3f} px, shift {shift[0]:+.3f} {shift[1]:+.3f} px")
    median = float(np.median(np.concatenate(every)))
    mean = np.mean(shifts, axis=0)
    print(f"all {len(shifts)}: median {median:.3f} px (limit {MAX_MEDIAN_px}), mean shift "
          f"{mean[0]:+.3f} {mean[1]:+.3f} px (limit {MAX_SHIFT_px})")
    if median >= MAX_MEDIAN_px or np.linalg.norm(mean) >= MAX_SHIFT_px:
        raise SystemExit("the pictures do not fit their poses")


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:])
