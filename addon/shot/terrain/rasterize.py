"""Rasterization of polygons and lines in NumPy, as Blender has no library for it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Covered = tuple[tuple[slice, slice], NDArray[np.float64]]
"""Rows and columns of a picture, and coverage (0..1) of these pixels."""


def filled(rings: Sequence[Array], shape: tuple[int, int]) -> Covered | None:
    """Coverage of a polygon: pixels with their centre inside, by the even-odd rule.

    Parameters
    ----------
    rings
        (n, 2) x and y in pixels, y from the first row on; holes are rings too.
    shape
        Rows and columns of the picture. The result is None if none of it is covered.
    """
    window = _window(np.concatenate(list(rings)), 0.0, shape)
    if window is None:
        return None
    rows, columns = window
    starts = np.concatenate(list(rings))
    ends = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    middle = np.arange(columns.start, columns.stop) + 0.5
    cover = np.zeros((rows.stop - rows.start, len(middle)))
    for number, y in enumerate(np.arange(rows.start, rows.stop) + 0.5):
        crosses = (starts[:, 1] <= y) != (ends[:, 1] <= y)
        a, b = starts[crosses], ends[crosses]
        x = np.sort(a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0]))
        cover[number] = np.searchsorted(x, middle) % 2
    return window, cover


def stroked(line: Array, width: float, shape: tuple[int, int]) -> Covered | None:
    """Coverage of a line (n, 2) with a width, all in pixels, with anti-aliased edges; None if none."""
    half = 0.5 * width
    window = _window(line, half + 1.0, shape)
    if window is None or len(line) < 2:
        return None
    rows, columns = window
    cover = np.zeros((rows.stop - rows.start, columns.stop - columns.start))
    for a, b in pairwise(line):
        part = _window(np.stack([a, b]), half + 1.0, shape)
        if part is None:
            continue
        y, x = np.mgrid[part[0], part[1]] + 0.5
        along = b - a
        t = ((x - a[0]) * along[0] + (y - a[1]) * along[1]) / max(float(along @ along), 1.0e-12)
        t = np.clip(t, 0.0, 1.0)
        off = np.hypot(x - a[0] - t * along[0], y - a[1] - t * along[1])
        near = np.clip(half + 0.5 - off, 0.0, min(1.0, width))  # thinner than a pixel: partial coverage
        inner = tuple(slice(p.start - w.start, p.stop - w.start) for p, w in zip(part, window, strict=True))
        cover[inner] = np.maximum(cover[inner], near)
    return window, cover


def _window(points: Array, more: float, shape: tuple[int, int]) -> tuple[slice, slice] | None:
    """Rows and columns around points with a margin, clipped to the picture."""
    slices = []
    for axis, count in ((1, shape[0]), (0, shape[1])):
        first = max(int(np.floor(points[:, axis].min() - more)), 0)
        last = min(int(np.ceil(points[:, axis].max() + more)), count)
        if last <= first:
            return None
        slices.append(slice(first, last))
    return slices[0], slices[1]
