"""Moving camera targets from fire arrival times: the fire's head and its centre."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ...run import extent
from ..terrain.terrain import NEVER, UNKNOWN, Terrain, box
from .path import hann_mean

Array = NDArray[np.float64]

MOVING = ("head", "fire")  # moving targets
_RECENT = 1800.0  # s; in a large fire, ground that burned within this time belongs to the active front
_SAMPLES = 241  # times of a shot at which a path is computed that follows the fire
_KNOTS = 24  # times at which the target is computed; it is interpolated between
_BLOCK = 1500.0  # m, blocks of a large fire's front that are compared
_LARGE = 20_000.0  # m, fire size from which block and time apply; they shrink with smaller fires
_AT_ONCE = 1.0  # s, cells that begin to burn within this time are one ignition
_SHORT = 300.0  # s; in a shorter shot the head moves evenly (assumed)
_FASTEST = 5.0  # m/s, upper limit of the rate of spread
_CELLS = 4.0  # fuel cells, lower bound of block size and front depth
_HYSTERESIS = 4.0  # blocks; distance in which another head must be e times as strong to be followed

_tracks: WeakKeyDictionary[Terrain, dict[tuple[str, float, float], tuple[Array, Array]]] = WeakKeyDictionary()


def follow(target: str, ground: Terrain, times: Array, above: float) -> Array:
    """Look-at points (frames, 3) that follow the "head" or the centre of the "fire".

    Parameters
    ----------
    above
        Height above ground, m.
    """
    moments = samples(times)
    east, north = _track(target, ground, moments)
    place = ground.point(*ground.geodetic(east, north), above)
    place[:, 2] = smoothed(place[:, 2])
    return at_frames(place, times)


def samples(times: Array) -> Array:
    """Return even times (n,) of a shot, s: a path computed at them does not depend on the number of frames.

    Parameters
    ----------
    times
        (frames,) s.
    """
    return np.unique(np.linspace(times[0], times[-1], _SAMPLES))


def at_frames(sampled: Array, times: Array) -> Array:
    """Interpolate points (n, 3) at the samples of a shot to its frames (frames, 3)."""
    moments = samples(times)
    return np.stack([np.interp(times, moments, values) for values in sampled.T], axis=-1)


def _track(target: str, ground: Terrain, moments: Array) -> tuple[Array, Array]:
    """East and north (n,) of a target, computed once: auto framing tries many cameras on one target."""
    known, key = _tracks.setdefault(ground, {}), (target, float(moments[0]), float(moments[-1]))
    if key not in known:
        known[key] = (head if target == "head" else middle)(ground, moments)
    return known[key]


def head(ground: Terrain, times: Array) -> tuple[Array, Array]:
    """East and north (frames,) of the head: the block of the front with the highest rate of spread.

    In a shot that is shorter than the time in which the front crosses a block the head moves evenly, by the
    front's mean velocity around it. Otherwise it would jump as single cells begin to burn.
    """
    east, north, arrival, speed = _burned(ground)
    block, recent = _scale(ground, speed, times[-1])
    if 0.0 < times[-1] - times[0] < min(recent, _SHORT):
        place = _head_at(times[-1], None, east, north, arrival, speed, block, recent)
        velocity = _velocity(ground, place, block)
        track = place + (times - times[-1])[:, None] * velocity
        return track[:, 0], track[:, 1]
    return _follow(times, lambda t, last: _head_at(t, last, east, north, arrival, speed, block, recent))


def middle(ground: Terrain, times: Array) -> tuple[Array, Array]:
    """East and north (frames,) of the centre of the burning ground."""
    east, north, arrival, speed = _burned(ground)
    recent = _scale(ground, speed, times[-1])[1]
    return _follow(times, lambda t, last: _middle_at(t, last, east, north, arrival, recent))


def ignition(ground: Terrain) -> tuple[float, float]:
    """East and north of the ground that burns first."""
    east, north, arrival, _ = _burned(ground)
    if len(arrival) == 0:
        return 0.0, 0.0
    first = arrival <= arrival.min() + _AT_ONCE
    return float(east[first].mean()), float(north[first].mean())


def smoothed(values: Array) -> Array:
    """Return the moving average over a fifth of the shot; the ends are continued."""
    reach = max(len(values) // 10, 1)
    return hann_mean(np.pad(values, reach, "edge"), reach)


def _burned(ground: Terrain) -> tuple[Array, Array, Array, Array]:
    """East, north (m), arrival time (s) and rate of spread (m/s) of every cell that burns."""
    near = box(ground.arrival < NEVER, more=1)
    if near is None:
        return np.empty(0), np.empty(0), np.empty(0), np.empty(0)
    arrival, time = ground.arrival[near], ground.burn_time[near]
    burned = arrival < NEVER
    with np.errstate(divide="ignore"):
        slope = np.hypot(*np.gradient(np.where(time < UNKNOWN, time, np.nan), *ground.cell))
    row, column = (at + part.start for at, part in zip(np.nonzero(burned), near, strict=True))
    latitude, longitude = ground.places(row, column)
    point = ground.frame.forward(latitude, longitude, ground.fields.elevation[row, column])
    speed = 1.0 / np.clip(np.nan_to_num(slope[burned], nan=10.0), 0.1, 100.0)
    return point[:, 0], point[:, 1], arrival[burned], np.minimum(speed, _FASTEST)


def _velocity(ground: Terrain, place: Array, size: float) -> Array:
    """Return the mean velocity (2,) of the front around a place, m/s, weighted within about `size` m."""
    near = box(ground.arrival < NEVER, more=1)
    if near is None:
        return np.zeros(2)
    time = ground.burn_time[near]
    with np.errstate(invalid="ignore"):
        slope = np.stack(np.gradient(np.where(time < UNKNOWN, time, np.nan), *ground.cell)[::-1], axis=-1)
    row, column = (
        at + part.start for at, part in zip(np.nonzero(ground.arrival[near] < NEVER), near, strict=True)
    )
    slope = slope[row - near[0].start, column - near[1].start]
    point = ground.frame.forward(*ground.places(row, column), ground.fields.elevation[row, column])
    steep = np.hypot(*slope.T)
    weight = np.exp(-np.sum((point[:, :2] - place) ** 2, axis=1) / (2.0 * size**2))
    known = np.isfinite(steep) & (steep > 0.0)
    if not np.any(weight[known] > 0.0):
        return np.zeros(2)
    speed = np.minimum(1.0 / steep[known], _FASTEST)
    return np.average(slope[known] / steep[known, None] * speed[:, None], axis=0, weights=weight[known])


def _follow(times: Array, place: Callable[[float, Any], Any]) -> tuple[Array, Array]:
    """Track of a target: sampled at a few times, interpolated and smoothed over the shot."""
    knots = np.linspace(times[0], times[-1], min(len(times), _KNOTS))
    last: Any = None
    positions = []
    for time in knots:
        last = place(time, last)
        positions.append(last)
    track = np.array(positions)
    x, y = (smoothed(np.interp(times, knots, track[:, axis])) for axis in (0, 1))
    return x, y


def _scale(ground: Terrain, speed: Array, time: float) -> tuple[float, float]:
    """Block size (m) for comparing parts of the front, and time (s) for which ground belongs to the front.

    Parameters
    ----------
    speed
        (n,) rate of spread of all burning cells, m/s.
    time
        Time up to which the fire's largest size counts, s.
    """
    size = extent.largest(ground.arrival <= time, ground.cell)
    if size <= 0.0:
        return _BLOCK, _RECENT
    part, cells = min(size / _LARGE, 1.0), _CELLS * max(ground.cell)
    return max(part * _BLOCK, cells), min(max(part * _RECENT, cells / float(np.median(speed))), _RECENT)


def _front(time: float, arrival: Array, recent: float) -> NDArray[np.int64]:
    """Return indices of the cells that burned in the `recent` s before `time`, or else nearest to it."""
    recent_cells = np.flatnonzero((arrival <= time) & (arrival > time - recent))
    if len(recent_cells) or len(arrival) == 0:
        return recent_cells
    return np.argsort(np.abs(arrival - time))[:50]


def _head_at(
    time: float,
    last: Array | None,
    east: Array,
    north: Array,
    arrival: Array,
    speed: Array,
    size: float,
    recent: float,
) -> Array:
    front = _front(time, arrival, recent)
    if len(front) == 0:
        return np.zeros(2) if last is None else last
    e, n = east[front], north[front]
    weight = speed[front] ** 2 * np.exp((arrival[front] - time) / (0.5 * recent))
    block = np.round(e / size).astype(np.int64) * 1_000_003 + np.round(n / size).astype(np.int64)
    blocks, member = np.unique(block, return_inverse=True)
    total = np.bincount(member, weight, len(blocks))
    centre = np.stack([np.bincount(member, weight * v, len(blocks)) / total for v in (e, n)], axis=-1)
    if last is not None:  # keep the followed head unless another one is much faster
        total = total * np.exp(-np.linalg.norm(centre - last, axis=1) / (_HYSTERESIS * size))
    best = centre[np.argmax(total)]
    near = weight * np.exp(-((e - best[0]) ** 2 + (n - best[1]) ** 2) / (2.0 * size**2))
    return np.array([np.sum(near * e), np.sum(near * n)]) / np.sum(near)


def _middle_at(
    time: float, last: Array | None, east: Array, north: Array, arrival: Array, recent: float
) -> Array:
    front = _front(time, arrival, recent)
    if len(front) == 0:
        return np.zeros(2) if last is None else last
    return np.array([np.mean(east[front]), np.mean(north[front])])
