"""Keyframe reduction: few keys with slopes replace one key per frame, so that a path can be edited."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from .path import Array


def keys(values: Array, tolerance: float) -> tuple[NDArray[np.int64], Array]:
    """Reduce curves to Hermite keys: frames (k,) from 0, and slopes (k, channels) per frame.

    `values` are (frames, channels). The cubics are within `tolerance` of them in every frame (Euclidean norm
    over channels). Slopes are central differences. A segment with a larger error is split at its worst frame,
    so a curve that is not smooth ends with a key in every frame.
    """
    last = len(values) - 1
    if last < 1:
        return np.arange(len(values)), np.zeros(values.shape)
    slope = np.gradient(values, axis=0, edge_order=1 if last < 2 else 2)
    chosen = np.array([0, last])
    while True:
        error = np.linalg.norm(curve(chosen, values[chosen], slope[chosen], last + 1) - values, axis=1)
        error[chosen] = 0.0
        worst = [a + int(np.argmax(error[a:b])) for a, b in itertools.pairwise(chosen)]
        more = [frame for frame in worst if error[frame] > tolerance]
        if not more:
            return chosen, slope[chosen]
        chosen = np.sort(np.append(chosen, more))


def fit(values: Array, tolerance: float, first: tuple[int, ...] = ()) -> NDArray[np.int64]:
    """Reduce curves (frames, channels) to key frames (k,), from 0, that `through` interpolates.

    Parameters
    ----------
    tolerance
        Largest error of `through` in any frame, as Euclidean norm over channels.
    first
        Frames that are always keys.
    """
    last, moments = len(values) - 1, np.arange(len(values), dtype=np.float64)
    chosen = np.unique([0, last, *(frame for frame in first if 0 <= frame <= last)])
    while True:
        error = np.linalg.norm(through(chosen.astype(np.float64), values[chosen], moments) - values, axis=1)
        error[chosen] = 0.0
        worst = [a + int(np.argmax(error[a:b])) for a, b in itertools.pairwise(chosen)]
        more = [frame for frame in worst if error[frame] > tolerance]
        if not more:
            return chosen
        chosen = np.sort(np.append(chosen, more))


def through(at: Array, values: Array, moments: Array) -> Array:
    """Cubic interpolation (moments, channels) through values (k, channels) at `at` (k,), clamped outside.

    The slope at a key is the slope of the parabola through the key and its neighbours.
    """
    if len(at) == 1:
        return np.repeat(values, len(moments), axis=0)
    slopes = np.gradient(values, at, axis=0, edge_order=1 if len(at) < 3 else 2)
    return _cubics(at, values, slopes, np.clip(moments, at[0], at[-1]))


def curve(kept: NDArray[np.int64], values: Array, slopes: Array, frames: int) -> Array:
    """Evaluate Hermite cubics with values and slopes (k, channels) at frames (k,) in all frames."""
    return _cubics(kept, values, slopes, np.arange(frames))


def _cubics(at: NDArray, values: Array, slopes: Array, t: NDArray) -> Array:
    i = np.clip(np.searchsorted(at, t, "right") - 1, 0, len(at) - 2)
    gap = (at[i + 1] - at[i]).astype(np.float64)[:, None]
    s = (t - at[i])[:, None] / gap
    a, b = values[i], values[i + 1]
    bend = (1.0 - s) * (slopes[i] * gap - (b - a)) + s * ((b - a) - slopes[i + 1] * gap)
    return a + s * (b - a) + s * (1.0 - s) * bend
