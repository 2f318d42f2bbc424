"""Few keys with slopes in place of one for every frame, so that people can edit a way."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from .path import Array


def keys(values: Array, tolerance: float) -> tuple[NDArray[np.int64], Array]:
    """Frames (k,) from 0 to keep of values (frames, channels), and slopes (k, channels) per frame at them.

    Cubics with these values and slopes at their ends are within `tolerance` (of the length of the difference
    of all channels) of the values in every frame. Slopes are central differences; each stretch that is not
    good enough is cut where it is worst, so that what is not smooth ends with a key in every frame.
    """
    last = len(values) - 1
    if last < 1:
        return np.arange(len(values)), np.zeros(values.shape)
    slope = np.gradient(values, axis=0, edge_order=min(last, 2))
    kept = np.array([0, last])
    while True:
        error = np.linalg.norm(curve(kept, values[kept], slope[kept], last + 1) - values, axis=1)
        error[kept] = 0.0
        worst = [a + int(np.argmax(error[a:b])) for a, b in itertools.pairwise(kept)]
        more = [frame for frame in worst if error[frame] > tolerance]
        if not more:
            return kept, slope[kept]
        kept = np.sort(np.append(kept, more))


def curve(kept: NDArray[np.int64], values: Array, slopes: Array, frames: int) -> Array:
    """What cubics (Hermite) through values and slopes (k, channels) at frames (k,) give in all frames."""
    t = np.arange(frames)
    i = np.clip(np.searchsorted(kept, t, "right") - 1, 0, len(kept) - 2)
    gap = (kept[i + 1] - kept[i]).astype(np.float64)[:, None]
    s = (t - kept[i])[:, None] / gap
    a, b = values[i], values[i + 1]
    bend = (1.0 - s) * (slopes[i] * gap - (b - a)) + s * ((b - a) - slopes[i + 1] * gap)
    return a + s * (b - a) + s * (1.0 - s) * bend
