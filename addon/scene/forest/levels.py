"""Level of detail of crowns: fewer triangles of equal cover and brightness."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .branching import Leaves
from .habit import Fit
from .shape import Array, Shape

LEVELS = 4
PIXELS = (40.0, 12.0, 4.0)  # level 0 if taller, then 1, 2, and 3 if smaller


def level(pixels: ArrayLike) -> NDArray[np.int64]:
    """Level of detail (n,) of trees of these heights (n,) in pixels."""
    return np.sum(np.asarray(pixels)[..., None] < np.array(PIXELS), axis=-1)


def some(shape: Shape, leaves: Leaves, count: int, fit: Fit) -> None:
    """Add a random subset of about `count` leaves, enlarged to the area of all leaves.

    Stochastic simplification: Cook, Halstead, Planck, Ryu 2007.
    """
    step = max(len(leaves.middle) / count, 1.0)
    kept = (np.arange(int(len(leaves.middle) / step)) * step).astype(int)
    middle, corners = leaves.middle[kept], leaves.corners()[kept]
    corners = middle[:, None] + (corners - middle[:, None]) * np.sqrt(step)
    _add(shape, corners, leaves.colour[kept], fit)


def fans(shape: Shape, leaves: Leaves, groups: NDArray[np.int64], fit: Fit) -> None:
    """Add two triangles for each group of leaves, with the group's mean position, extent and colour.

    A triangle whose corners lie twice the standard deviation from its centre has that deviation.

    Parameters
    ----------
    groups
        (n,) group index of each leaf.
    """
    _, number, count = np.unique(groups, return_inverse=True, return_counts=True)

    def mean(values: Array) -> Array:
        columns = values.reshape(len(values), -1)
        sums = np.stack([np.bincount(number, column) for column in columns.T], axis=-1)
        return (sums / count[:, None]).reshape(-1, *values.shape[1:])

    middle, colour = mean(leaves.middle), mean(leaves.colour)
    off = leaves.middle - middle[number]
    spread = mean(off[:, :, None] * off[:, None, :] + leaves.along[:, :, None] * leaves.along[:, None, :] / 3)
    variance, axes = np.linalg.eigh(spread)
    half = 2.0 * np.sqrt(np.maximum(variance, 1.0e-10))[:, None, :] * axes
    thin, wide, long = half[..., 0], half[..., 1], half[..., 2]
    long = np.where(np.sum(long * middle, axis=-1, keepdims=True) < 0.0, -long, long)
    angles = 2.0 * np.pi * np.arange(3)[None, :, None] / 3
    for other, turn in ((wide + 0.3 * thin, 0.0), (0.5 * wide - 1.2 * thin, np.pi)):
        reach = np.cos(angles + turn) * long[:, None] + np.sin(angles + turn) * other[:, None]
        _add(
            shape,
            middle[:, None] + reach,
            colour,
            fit,
            (leaves.middle[:, 2].min(), leaves.middle[:, 2].max()),
        )


def slabs(leaves: Leaves) -> NDArray[np.int64]:
    """Group leaves (n,): horizontal slabs of equal counts, divided into sectors around the trunk.

    A tall crown has many slabs of few sectors, a wide crown the reverse.
    """
    x, y, z = leaves.middle.T
    layers, sectors = (5, 2) if z.std() > x.std() else (2, 5)
    slab = np.argsort(np.argsort(z)) * layers // len(z)
    turn = np.arctan2(y, x) / (2.0 * np.pi) + slab / (2.0 * sectors)
    return slab * sectors + np.floor(sectors * (turn % 1.0)).astype(np.int64)


def _add(
    shape: Shape, corners: Array, colour: Array, fit: Fit, crown: tuple[float, float] = (-np.inf, np.inf)
) -> None:
    """Add triangles (n, 3, 3) of colours (n, 3), scaled about their centres and clamped to the crown."""
    middle = corners.mean(axis=1, keepdims=True)
    corners = middle + (corners - middle) * np.array([fit[0], fit[0], fit[1]])
    corners[..., 2] = np.clip(corners[..., 2], *crown)
    shape.leaves(corners, colour * fit[2])
