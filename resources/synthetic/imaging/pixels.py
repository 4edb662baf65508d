# SPDX-License-Identifier: Apache-2.0
"""Pictures as arrays: noise filter, resampling, sensor, and PNG files."""

import math
import struct
import zlib

import numpy as np

# Half of the eight neighbours; the other half are the same pairs seen from the other end.
PAIRS = ((0, 1, 0.5), (1, 0, 0.5), (1, 1, 0.25), (1, -1, 0.25))
MAX_LEVELS = 4


def smooth(lights, guides):
    """Edge-stopping wavelet filter (Dammertz 2010) of pictures of the same scene.

    `lights` are (picture, levels, relative, absolute): how far it is filtered, and what difference
    to a neighbour counts as noise at first, of the local mean and in addition (a number or a
    picture); both halve with every level, as the noise does. `guides` are (picture, sigma) without noise: what differs in them is not mixed.
    """
    pictures = [picture for picture, *_ in lights]
    guides = [picture * np.float32(1.0 / sigma) for picture, sigma in guides]
    for level in range(MAX_LEVELS):
        active = [i for i, (_, levels, _, _) in enumerate(lights) if level < levels]
        floors = {i: 0.5 ** level * (lights[i][2] * _box(pictures[i], 3 * 2 ** level)
                                     + lights[i][3] + np.float32(1e-4)) for i in active}
        totals = {i: pictures[i].copy() for i in active}
        weights = {i: np.ones_like(pictures[i]) for i in active}
        for dy, dx, kernel in PAIRS:
            here, there = _pair(dy * 2 ** level, dx * 2 ** level)
            apart = sum((g[here] - g[there]) ** 2 for g in guides)
            for i in active:
                p = pictures[i]
                distance = apart + ((p[here] - p[there]) / floors[i][here]) ** 2
                weight = kernel * np.exp(-np.minimum(distance, 40.0))
                totals[i][here] += weight * p[there]
                totals[i][there] += weight * p[here]
                weights[i][here] += weight
                weights[i][there] += weight
        for i in active:
            pictures[i] = totals[i] / weights[i]
    return pictures


def _pair(dy, dx):
    """Slices of a picture whose pixels are (dy, dx) apart; dy is not negative."""
    rows = (slice(None, -dy or None), slice(dy, None))
    columns = (slice(None, -dx or None), slice(dx, None)) if dx >= 0 else (
        slice(-dx, None), slice(None, dx))
    return (rows[0], columns[0]), (rows[1], columns[1])


def _box(image, radius):
    """Mean over a square, by running sums."""
    size = 2 * radius + 1
    padded = np.pad(image.astype(np.float64), radius + 1, mode="edge")
    sums = padded.cumsum(0).cumsum(1)
    inner = (sums[size:, size:] - sums[:-size, size:] - sums[size:, :-size] + sums[:-size, :-size])
    return (inner[:image.shape[0], :image.shape[1]] / size ** 2).astype(np.float32)


def _cubic(t):
    """Catmull-Rom weights of the four neighbours."""
    return (0.5 * t * (-1 + t * (2 - t)), 1 + 0.5 * t * t * (-5 + 3 * t),
            0.5 * t * (1 + t * (4 - 3 * t)), 0.5 * t * t * (t - 1))


def sample(image, x, y):
    """The image at real coordinates (bicubic), in one pass."""
    height, width = image.shape
    column, row = np.floor(x).astype(np.int32), np.floor(y).astype(np.int32)
    wx, wy = _cubic((x - column).astype(np.float32)), _cubic((y - row).astype(np.float32))
    flat, made = image.ravel(), np.zeros(x.shape, dtype=np.float32)
    for i in range(4):
        rows = np.clip(row + i - 1, 0, height - 1) * width
        line = np.zeros(x.shape, dtype=np.float32)
        for j in range(4):
            line += wx[j] * flat[rows + np.clip(column + j - 1, 0, width - 1)]
        made += wy[i] * line
    return made


def blur(image, sigma):
    """Gaussian, separable."""
    radius = max(1, math.ceil(3 * sigma))
    weights = np.exp(-0.5 * (np.arange(-radius, radius + 1) / sigma) ** 2)
    weights = (weights / weights.sum()).astype(np.float32)
    for axis in (0, 1):
        padded = np.pad(image, [(radius, radius) if a == axis else (0, 0) for a in (0, 1)],
                        mode="edge")
        count = image.shape[axis]
        image = sum(w * np.take(padded, range(i, i + count), axis=axis)
                    for i, w in enumerate(weights))
    return image


def expose(radiance, gain, sensor, generator):
    """Photons to 8 bit: glare, shot and read noise, full well, linear quantization."""
    signal = gain * (radiance + sensor["glare"] * float(radiance.mean()))
    if sensor["blur_px"] > 0.0:
        signal = blur(signal, sensor["blur_px"])
    electrons = np.maximum(signal, 0.0) * sensor["full_well"]
    electrons = electrons + np.sqrt(electrons) * generator.standard_normal(
        electrons.shape, dtype=np.float32)
    electrons += sensor["read_noise"] * generator.standard_normal(electrons.shape,
                                                                  dtype=np.float32)
    return np.clip(electrons * (255.0 / sensor["full_well"]) + 0.5, 0, 255).astype(np.uint8)


def write_png(path, image):
    """Grey, 8 or 16 bit."""
    depth = 8 * image.dtype.itemsize
    rows = image.astype(">u2").view(np.uint8) if depth == 16 else image
    height, stride = rows.shape
    before = np.zeros_like(rows)
    step = depth // 8
    before[:, step:] = rows[:, :-step]  # filter 1: the difference to the pixel on the left
    filtered = np.empty((height, stride + 1), dtype=np.uint8)
    filtered[:, 0] = 1
    filtered[:, 1:] = rows - before
    header = struct.pack(">IIBBBBB", image.shape[1], image.shape[0], depth, 0, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, body in ((b"IHDR", header), (b"IDAT", zlib.compress(filtered.tobytes(), 6)),
                           (b"IEND", b"")):
            file.write(struct.pack(">I", len(body)) + kind + body
                       + struct.pack(">I", zlib.crc32(kind + body)))


def read_png(path):
    """A grey 8-bit PNG of this generator (another filter is refused)."""
    with open(path, "rb") as file:
        data = file.read()
    at, body, header = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", data[at + 8:at + 8 + length])
        elif kind == b"IDAT":
            body += data[at + 8:at + 8 + length]
        at += 12 + length
    width, height, depth, colour, _, _, interlace = header
    if (depth, colour, interlace) != (8, 0, 0):
        raise ValueError(f"{path}: not a plain 8-bit grey PNG")
    rows = np.frombuffer(zlib.decompress(body), np.uint8).reshape(height, width + 1)
    if not (rows[:, 0] == 1).all():
        raise ValueError(f"{path}: not written by this generator")
    return np.cumsum(rows[:, 1:], axis=1, dtype=np.uint8)
