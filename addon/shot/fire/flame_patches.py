"""Patches of the ground on which flames are drawn: finer where they are near the camera.

A patch has `SIDE` x `SIDE` cells. Its corner is a multiple of its width, and widths are powers of two times
that of the finest patch: patches are the leaves of a quadtree. The camera selects patches; values of a node
depend on its place, the spacing and time alone. Needs no Blender.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import flame_nodes, flame_window
from .flame_nodes import SIDE
from .flame_view import FADE, ViewCone

FINEST, COARSEST = 0.25, 128.0  # m, spacings
_PIXELS = 2.0  # upper bound of the spacing, pixels
_FEW = 1.0  # pixels; flames that need finer cells than this do not get them
_CELLS_HIGH = 4.0  # cells along a typical flame, if pixels resolve them
_SMOOTH = 1.0  # m, spacing that resolves the noise of a front with tall flames
_ABOVE = 60.0  # m that flames may lean or rise into a picture

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Patches:
    """Flames on n patches of the ground at one time.

    Neighbours of the same spacing share a row or column of nodes. There are no flames without a patch.

    Attributes
    ----------
    nodes
        (n, SIDE + 1, SIDE + 1, 8) values at nodes; rows to the north, columns to the east; for the values see
        `flame_nodes`.
    corners
        (n, 2) scene x and y of the first node, m.
    spacings
        (n,) distance between nodes, m.
    """

    nodes: NDArray[np.float32]
    corners: Array
    spacings: Array

    @property
    def burns(self) -> NDArray[np.bool_]:
        """Mask (n, SIDE + 1, SIDE + 1) of nodes with flames or where flames will soon be."""
        return self.nodes[..., flame_nodes.LENGTH] > 0.0


def build(
    shot: Any,
    eye: Array,
    time: float,
    limit: float,
    pixel: float,
    lens: ViewCone | None,
    wind: tuple[float, float],
) -> Patches:
    """Return the flames around a camera; for the parameters see `flame_map.patches`."""
    window = flame_window.find(shot, time)
    none = Patches(np.empty((0, SIDE + 1, SIDE + 1, 8), np.float32), np.empty((0, 2)), np.empty(0))
    if window is None:
        return none
    corners, spacings = _Tree(shot, window, eye, FADE[1] * limit, pixel, lens).leaves()
    parts = []
    for spacing in np.unique(spacings):
        here = corners[spacings == spacing]
        nodes = flame_nodes.values(shot, window, here, float(spacing), wind)
        kept = flame_nodes.shows(nodes, float(spacing)).any(axis=(1, 2))
        if kept.any():
            parts.append(Patches(nodes[kept], here[kept], np.full(int(kept.sum()), spacing)))
    if not parts:
        return none
    return Patches(*(np.concatenate(each) for each in zip(*map(_fields, parts), strict=True)))


def _fields(patches: Patches) -> tuple[NDArray[np.float32], Array, Array]:
    return patches.nodes, patches.corners, patches.spacings


@dataclass
class _Tree:
    """Search for the patches that a camera needs."""

    shot: Any
    window: flame_window.FlameWindow
    eye: Array
    limit: float
    pixel: float
    lens: ViewCone | None

    def leaves(self) -> tuple[Array, Array]:
        """Return corners (n, 2) and spacings (n,) of patches, m, with flames in view."""
        spacing = COARSEST
        width = SIDE * spacing
        low, high = (np.floor((self.eye[:2] + sign * self.limit) / width) for sign in (-1.0, 1.0))
        axes = [np.arange(first, last + 1.0) * width for first, last in zip(low, high, strict=True)]
        corners = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
        chosen: list[tuple[Array, Array]] = []
        while len(corners):
            corners, wanted = self._seen(corners, spacing)
            leaf = wanted >= spacing
            chosen.append((corners[leaf], np.full(int(leaf.sum()), spacing)))
            spacing *= 0.5
            quarters = SIDE * spacing * np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)])
            corners = (corners[~leaf, None] + quarters).reshape(-1, 2)
        found = [np.concatenate(each) for each in zip(*chosen, strict=True)] if chosen else []
        return (found[0], found[1]) if found else (np.empty((0, 2)), np.empty(0))

    def _seen(self, corners: Array, spacing: float) -> tuple[Array, Array]:
        """Return the squares (n, 2) with flames in view, and the spacing (n,) that they need, m."""
        width = SIDE * spacing
        nearest = np.clip(self.eye[:2], corners, corners + width) - self.eye[:2]
        corners = corners[np.hypot(*nearest.T) < self.limit]
        if not len(corners):
            return corners, np.empty(0)
        ground = self.shot.ground
        middle = corners + 0.5 * width
        latitude, longitude = ground.geodetic(*middle.T)
        row, column = ground.indices(latitude, longitude)
        half = 0.5 * width / np.array(ground.cell) + 0.01
        at = np.stack([row, column], axis=-1)
        kept = self.window.touches(at - half, at + half)
        corners, middle, row, column = corners[kept], middle[kept], row[kept], column[kept]
        height = ground.point(latitude[kept], longitude[kept])[:, 2]
        if self.lens is not None:
            offset = np.column_stack([middle, height]) - self.eye
            kept = self.lens.sees(offset, width + _ABOVE)
            corners, height, row, column = corners[kept], height[kept], row[kept], column[kept]
        nearest = np.clip(self.eye[:2], corners, corners + width) - self.eye[:2]
        over = np.maximum(np.abs(self.eye[2] - height) - 0.5 * width, 0.0)
        away = np.hypot(np.hypot(*nearest.T), over)
        kept = away < self.limit
        length = self.window.typical_length(row[kept], column[kept])
        return corners[kept], _spacing(self.pixel * away[kept], length)


def _spacing(pixel: Array, length: Array) -> Array:
    """Return the spacing (n,), m, of patches with a size of pixels (m) and a typical flame length (m)."""
    high = np.where(length > 0.0, length / _CELLS_HIGH, np.inf)
    spacing = np.minimum(_PIXELS * pixel, np.maximum(high, _FEW * pixel))
    spacing = np.clip(spacing, np.clip(high, FINEST, _SMOOTH), COARSEST)
    return 2.0 ** np.floor(np.log2(spacing))
