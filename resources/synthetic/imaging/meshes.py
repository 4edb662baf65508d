# SPDX-License-Identifier: Apache-2.0
"""The coarse meshes as files: binary PLY in metres, and BOP's models in millimetres."""

import json
import os

import numpy as np

from plan import BOP_OBJECTS

HEAD = ("ply\nformat {} 1.0\ncomment {}\nelement vertex {}\n{}element face {}\n"
        "property list uchar int vertex_indices\nend_header\n")


def joined(solids):
    """Vertices (mm, single precision as in the file) and triangles of all parts, without the
    slivers that a file with fewer digits would make of them."""
    vertices, triangles, count = [], [], 0
    for name in sorted(solids):
        vertices.append(solids[name].vertices)
        triangles.append(solids[name].triangles + count)
        count += len(solids[name].vertices)
    vertices = np.round(np.vstack(vertices), 4)
    unique, index = np.unique(vertices, axis=0, return_inverse=True)
    triangles = index[np.vstack(triangles)]
    a, b, c = (unique[triangles[:, i]] for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return unique, triangles[area > 1e-6]


def vertex_normals(vertices, triangles):
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    facing = np.cross(b - a, c - a)
    made = np.zeros_like(vertices)
    for i in range(3):
        np.add.at(made, triangles[:, i], facing)
    return made / np.maximum(np.linalg.norm(made, axis=1, keepdims=True), 1e-12)


def diameter(vertices):
    """The largest distance between two vertices."""
    largest = 0.0
    for chunk in np.array_split(vertices, max(1, len(vertices) // 256)):
        d2 = ((chunk[:, None, :] - vertices[None, :, :]) ** 2).sum(2)
        largest = max(largest, float(d2.max()))
    return largest ** 0.5


def _replace(path, data):
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_name(path.name + ".part")
    draft.write_bytes(data)
    os.replace(draft, path)


def write(station, solids, albedos, root):
    """STATION/MATERIAL.ply of every material with parts.json, STATION/model.ply (all of them), and
    bop/models/obj_*.ply with its entry of models_info.json."""
    for name, solid in solids.items():
        _write_binary(root / station / f"{name}.ply", *joined({name: solid}))
    vertices, triangles = joined(solids)
    _write_binary(root / station / "model.ply", vertices, triangles)
    _write_bop(station, vertices, triangles, root)
    parts = [{"material": name, "albedo": albedos[name]} for name in sorted(solids)]
    _replace(root / station / "parts.json", (json.dumps(parts, indent=1) + "\n").encode())


def write_alone(station, solids, root):
    """STATION/NAME.ply of solids that are not of the station's model."""
    for name, solid in solids.items():
        _write_binary(root / station / f"{name}.ply", *joined({name: solid}))


def _write_binary(path, vertices, triangles):
    """A PLY file in metres."""
    faces = np.zeros(len(triangles), dtype=[("n", "u1"), ("v", "<i4", 3)])
    faces["n"], faces["v"] = 3, triangles
    text = HEAD.format("binary_little_endian", "metres", len(vertices), _fields("xyz"),
                       len(triangles))
    _replace(path, text.encode() + (vertices * 1e-3).astype("<f4").tobytes() + faces.tobytes())


def _fields(names):
    return "".join(f"property float {a}\n" for a in names)


def _write_bop(station, vertices, triangles, root):
    both = np.hstack([vertices, vertex_normals(vertices, triangles)])
    fields = _fields(["x", "y", "z", "nx", "ny", "nz"])
    lines = [HEAD.format("ascii", "millimetres", len(vertices), fields, len(triangles))]
    lines += [" ".join(f"{v:.6g}" for v in row) + "\n" for row in both]
    lines += [f"3 {a} {b} {c}\n" for a, b, c in triangles]
    _replace(root / "bop" / "models" / f"obj_{BOP_OBJECTS[station]:06d}.ply", "".join(lines).encode())
    _note_model(root / "bop" / "models" / "models_info.json", BOP_OBJECTS[station], vertices)


def _note_model(path, number, vertices):
    known = json.loads(path.read_text()) if path.exists() else {}
    low, size = vertices.min(0), vertices.max(0) - vertices.min(0)
    known[str(number)] = {"diameter": diameter(vertices),
                          **{f"min_{a}": float(v) for a, v in zip("xyz", low)},
                          **{f"size_{a}": float(v) for a, v in zip("xyz", size)}}
    _replace(path, json.dumps(known, indent=1).encode())
