"""Distance of the flames in each pixel of a picture, for the gaps of foliage in front of them.

The flames of a picture may be anywhere from metres to kilometres away. A few rays find the range of distances
around each cell; the rays of all cells then resolve that range.

In the King Fire, 50 and 90 % of the cells with flames are within 6 and 16 m of a march with 1500 distances if
the front is 2000 to 3500 m away, within 0.3 and 1.5 m at 120 to 330 m, and within 0.02 and 0.07 m at 20 to
40 m. With 48 distances from metres to kilometres alone it was 122 and 195 m, 5.9 and 15 m, and 0.7 and 1.4 m,
in 0.7 to 0.8 of the time.
"""

from __future__ import annotations

import numpy as np
from firetwin_core import volume
from firetwin_core.flames import FlameVolume
from numpy.typing import NDArray

from ..geometry.grids import dilate
from .rays import Rays

CELL = 2  # pixels along a cell of the result: flames are smoother than foliage
_NEAREST = 1.0e-3  # the nearest distance over the farthest
_EVERY = 4  # cells between the rays that find the range
_ROUGH, _INSIDE = 128, 24  # distances along these rays, and along others within the range
_OUTSIDE = 4  # distances before and behind the range, for flames that the few rays have missed
_WIDER = 1.05  # factor on the range, as flames have depth
_FAINT = 0.02  # of white: fainter flames are not seen in gaps

Array = NDArray[np.float32]


def measure(
    flames: FlameVolume, rays: Rays, light: volume.Illumination, farthest: float, white: float
) -> Array:
    """Return the distance (h, w) within which half of the flames' light is emitted, m; 0 without flames.

    Parameters
    ----------
    rays
        One ray in each cell.
    light
        Light in air without smoke.
    farthest
        Distance up to which flames are drawn, m.
    white
        Radiance that is white in the picture.
    """
    height, width = rays.directions.shape[:2]
    rough = rays.directions[::_EVERY, ::_EVERY]
    at = (farthest * np.geomspace(_NEAREST, 1.0, _ROUGH)).astype(np.float32)
    _, low, high, _ = _half(flames, rays, rough, light, np.broadcast_to(at, (*rough.shape[:2], _ROUGH)))
    if not (high > 0.0).any():
        low, high = np.full_like(low, at[0]), np.full_like(high, at[-1])
    ends = _ends(low, high, at).repeat(_EVERY, axis=0).repeat(_EVERY, axis=1)[:height, :width]
    distance, _, _, red = _half(flames, rays, rays.directions, light, ends)
    found = np.where(red > _FAINT * white, distance, 0.0).astype(np.float32)
    # Rays of a pixel begin up to a pixel aside of it.
    return np.where(found > 0.0, found, dilate(found, 1))


def _half(
    flames: FlameVolume, rays: Rays, directions: NDArray[np.float64], light: volume.Illumination, ends: Array
) -> tuple[Array, Array, Array, Array]:
    """Return the distance of half of the light (h, w), the ends next to it, m, and all of the light (red).

    Without flames the ends are 0.
    """
    size, taps = ends.shape[:2], ends.shape[2]
    flat = ends.reshape(-1, taps)
    red = volume.march(
        [], rays.origins, directions.reshape(-1, 3), flat, light, 0.5, pixel=rays.pixel, flames=flames
    )[..., 0]
    half = 0.5 * red[:, -1:]
    after = np.clip((red < half).sum(axis=1), 1, taps - 1)
    row = np.arange(len(red))
    low, high = flat[row, after - 1], flat[row, after]
    before, until = red[row, after - 1], red[row, after]
    part = np.clip((half[:, 0] - before) / np.maximum(until - before, 1.0e-9), 0.0, 1.0)
    lit = red[:, -1] > 0.0
    distance, low, high = low * (high / low) ** part, low * lit, high * lit
    return (
        distance.reshape(size),
        low.reshape(size),
        high.reshape(size),
        red[:, -1].reshape(size),
    )


def _ends(low: Array, high: Array, at: Array) -> Array:
    """Return distances (h, w, taps), m, most of them in the range of the flames around each ray.

    Rays without flames nearby get the range of the picture.
    """
    low, high = low / _WIDER, high * _WIDER
    lit = high > 0.0
    first, last = float(low[lit].min()) / _WIDER, float(high.max()) * _WIDER
    near, far = -dilate(np.where(lit, -low, -np.inf), 1), dilate(high, 1)
    near, far = (np.where(far > 0.0, each, end)[..., None] for each, end in ((near, first), (far, last)))
    before, behind = np.arange(_OUTSIDE) / _OUTSIDE, np.arange(1, _OUTSIDE + 1) / _OUTSIDE
    ends = [first * (near / first) ** before, near * (far / near) ** np.linspace(0.0, 1.0, _INSIDE)]
    ends += [far * (last / far) ** behind, np.full((*lit.shape, 1), at[-1])]
    return np.concatenate(ends, axis=-1).astype(np.float32)


def of_pixels(distance: Array, height: int, width: int) -> Array:
    """Repeat the cells (ch, cw) of a distance for the pixels (h, w) of a picture."""
    return distance.repeat(CELL, axis=0).repeat(CELL, axis=1)[:height, :width]
