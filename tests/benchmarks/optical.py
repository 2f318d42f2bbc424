"""Where patches of a picture go from one frame to another, in plain NumPy.

For each patch the whole-pixel shift with the least sum of squared differences, then Lucas and Kanade's steps
from there to parts of a pixel (Lucas and Kanade 1981, "An iterative image registration technique with an
application to stereo vision", IJCAI). Patches are compared less their means and over their deviations, so
that a change of light does not count as motion.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

REACH = 8  # px: the farthest whole-pixel shift that is tried
STEPS = 8
PLAIN = 1e-5  # least curvature, squared change of brightness per pixel, of a patch that can be followed
APART = 0.25  # px that there and back may differ
ALIKE = 0.7  # least correlation of a patch with where it has gone

Picture = NDArray[np.float64]
Array = NDArray[np.float64]


def colours(path: Path) -> Picture:
    """Red, green and blue (rows, columns, 3) of a picture as they are shown, 0 to 1."""
    import matplotlib.image

    return matplotlib.image.imread(path)[..., :3].astype(float)


def brightness(picture: Picture) -> Picture:
    """Of colours (..., 3) as they are shown, 0 to 1."""
    return picture @ np.array([0.2126, 0.7152, 0.0722])


def luminance(path: Path) -> Picture:
    """Brightness (rows, columns) of a picture as it is shown, 0 to 1."""
    return brightness(colours(path))


def smoothed(picture: Picture) -> Picture:
    """Binomial blur of 5 pixels: single pixels' noise is not followed."""
    for axis in (0, 1):
        wide = np.pad(picture, [(2, 2) if a == axis else (0, 0) for a in (0, 1)], "edge")
        parts = (np.take(wide, range(k, k + picture.shape[axis]), axis) for k in range(5))
        picture = sum(w * part for w, part in zip((1, 4, 6, 4, 1), parts, strict=True)) / 16.0
    return picture


def sample(picture: Picture, x: Array, y: Array) -> Array:
    """Values at places in pixels; linear between, the edge's outside."""
    x, y = (np.clip(at, 0.0, side - 1.001) for at, side in ((x, picture.shape[1]), (y, picture.shape[0])))
    i, j = x.astype(int), y.astype(int)
    u, v = x - i, y - j
    low = picture[j, i] * (1 - u) + picture[j, i + 1] * u
    return low * (1 - v) + (picture[j + 1, i] * (1 - u) + picture[j + 1, i + 1] * u) * v


def displacement(
    first: Picture, second: Picture, centre: NDArray[np.int64], side: int
) -> tuple[Array, NDArray[np.bool_]]:
    """Shifts (n, 2) px right and down of patches round centres (n, 2), and which (n,) can be trusted.

    Trusted are patches with edges in both directions, whose shift back is the same within `APART`, and that
    look alike (`ALIKE`) where they have gone.
    """
    first, second = smoothed(first), smoothed(second)
    there, curved, alike = _shift(first, second, centre.astype(float), side)
    back, _, _ = _shift(second, first, centre + there, side)
    steady = np.linalg.norm(there + back, axis=1) < APART
    return there, steady & (curved > PLAIN) & (alike > ALIKE) & (np.abs(there).max(axis=1) < REACH)


def _shift(first: Picture, second: Picture, centre: Array, side: int) -> tuple[Array, Array, Array]:
    """Shifts (n, 2), least curvature (n,), and correlation (n,) with what is there, of patches."""
    offset = np.arange(side) - side // 2
    x = centre[:, 0, None, None] + offset[None, None, :] + np.zeros((side, 1))
    y = centre[:, 1, None, None] + offset[None, :, None] + np.zeros((1, side))
    patch, spread = _level(sample(first, x, y))
    shift = _whole(patch, second, x, y)
    slope_y, slope_x = np.gradient(first)
    gx, gy = (sample(slope, x, y) / spread for slope in (slope_x, slope_y))
    gx, gy = (slope - slope.mean((1, 2), keepdims=True) for slope in (gx, gy))
    xx, xy, yy = ((a * b).mean((1, 2)) for a, b in ((gx, gx), (gx, gy), (gy, gy)))
    least = 0.5 * (xx + yy - np.hypot(xx - yy, 2 * xy)) * spread[:, 0, 0] ** 2
    determinant = np.maximum(xx * yy - xy * xy, 1e-20)
    for _ in range(STEPS):
        moved = sample(second, x + shift[:, 0, None, None], y + shift[:, 1, None, None])
        off = patch - _level(moved)[0]
        a, b = (gx * off).mean((1, 2)), (gy * off).mean((1, 2))
        step = np.stack([yy * a - xy * b, xx * b - xy * a], 1) / determinant[:, None]
        shift = shift + np.clip(step, -1.0, 1.0)
    return shift, least, 1.0 - 0.5 * (off**2).mean((1, 2))


def _whole(patch: Array, second: Picture, x: Array, y: Array) -> Array:
    """The whole-pixel shifts (n, 2) that fit best."""
    best, found = np.full(len(patch), np.inf), np.zeros((len(patch), 2))
    for down in range(-REACH, REACH + 1):
        for right in range(-REACH, REACH + 1):
            off = ((_level(sample(second, x + right, y + down))[0] - patch) ** 2).mean((1, 2))
            better = off < best
            best, found[better] = np.where(better, off, best), (right, down)
    return found


def _level(patches: Array) -> tuple[Array, Array]:
    """Patches (n, side, side) of mean 0 and deviation 1, and what theirs was."""
    level = patches - patches.mean(axis=(1, 2), keepdims=True)
    spread = np.maximum(np.sqrt((level**2).mean(axis=(1, 2), keepdims=True)), 1e-9)
    return level / spread, spread
