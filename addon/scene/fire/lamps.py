"""Lamp positions for the light of flames on ground and trees: a few dozen for the entire shot.

Lamps are static; F-curves change their energies with the heat released near them. They do not light smoke,
which is lit by the emission in its volume.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...run import sun
from ...shot.cameras.path import Path
from ...shot.fire import heat_release
from ...shot.light import exposure
from ...shot.shot import Shot
from ...shot.terrain import noise

LIGHT = 6.0e-4  # W of light per luminous W of heat at night; chosen by eye
_GLOW = 0.45  # share of that light from flame-lit smoke, which also lights the ground near a camera; by eye
_DUSK = 0.0, -8.0  # degrees, solar elevations between which that light appears
_REACH = 9000.0  # m from a camera; light on ground farther away is not visible
_NEAR = 150.0  # m from the camera; nearer lamps are not spaced more closely
_KEYS = 13  # maximum number of keyframes in the shot
_BLOCK = 120.0  # m; heat within this distance belongs to one lamp
_ROUNDS = 12
_HEIGHTS, _RADII, _SHARED = (12.0, 60.0), (6.0, 60.0), 25.0  # m
_LOWEST = 8.0  # m, height of the lamps of a small fire
# Lengths except `_REACH` and `_LOWEST` are for a fire of 15 km.

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Lamps:
    """n lamps at k keyframes.

    Attributes
    ----------
    time
        (k,) model time, s.
    position
        (n, 3) scene metres.
    radius
        (n,) m.
    heat
        (k, n) W that each lamp represents; the sum is the luminous heat near the cameras.
    """

    time: Array
    position: Array
    radius: Array
    heat: Array


def darkness(shot: Shot, times: Array) -> Array:
    """Return darkness at model times (n,), s: 0 by day to 1 at night, with a smooth start."""
    return exposure.darkness(shot, times) ** 2


def glow_share(shot: Shot) -> float:
    """Return the share of the lamps' light that comes from smoke at mid-shot; 0 by day."""
    return _GLOW * float(noise.smoothstep(*_DUSK, sun.position(shot.run, shot.frames.middle)[1]))


def place_lamps(shot: Shot, nearest: tuple[float, float] = (0.0, 0.0), least: float = 0.0) -> Lamps:
    """Cluster the luminous heat of all times near the cameras by weighted k-means (Lloyd 1982).

    Heat is weighted by its distance from a camera, so lamps are dense where their positions are visible. Heat
    is shared between nearby lamps, so that a passing front fades from one to the next. Without heat near a
    camera the result is empty. Heat fades to its part `least` between the distances `nearest` (m) towards a
    camera.
    """
    times, near = keyframe_times(shot), shot.perspective_paths
    none = Lamps(times, np.empty((0, 3)), np.empty(0), np.empty((len(times), 0)))
    if not near:
        return none
    parts = [
        _merge_sources(shot.fire.luminous(shot.fire.sources(float(t))), near, shot.scale.length(_BLOCK))
        for t in times
    ]
    position = np.concatenate([part.position for part in parts])
    power = np.concatenate([part.power for part in parts])
    moment = np.repeat(np.arange(len(times)), [len(part.power) for part in parts])
    distance = shot.visibility.distance(position)
    size = shot.scale.length
    power = power * np.clip((_REACH - distance) / (0.3 * _REACH), 0.0, 1.0)
    if nearest[1] > 0.0:
        power = power * (least + (1.0 - least) * noise.smoothstep(*nearest, distance))
    lit = np.flatnonzero(power > 0.0)
    if len(lit) == 0:
        return none
    position, power, moment, distance = position[lit], power[lit], moment[lit], distance[lit]
    weight = power / (distance**2 + size(_NEAR) ** 2)
    merged = np.full(len(weight), -1)
    spots = heat_release.Sources(position, weight, weight, 0.0 * weight, merged, merged)
    whole = heat_release.lights(spots, size(_BLOCK), 1_000_000)
    centre = _choose_centres(whole.position, whole.power, shot.settings.light.lamps, shot.settings.seed)
    gap = _squared_distances(position, centre)
    share = 1.0 / (gap + size(_SHARED) ** 2) ** 3
    share /= share.sum(axis=1, keepdims=True)
    total = np.zeros((len(times), len(centre)))
    np.add.at(total, moment, power[:, None] * share)
    spread = np.sqrt(
        (share * gap * weight[:, None]).sum(0) / np.maximum((share * weight[:, None]).sum(0), 1e-300)
    )
    low, high = (max(size(height), _LOWEST) for height in _HEIGHTS)
    above = np.clip(0.5 * spread, low, high)
    up = np.maximum(shot.ground.up(centre[:, 0], centre[:, 1]), centre[:, 2]) + above
    small, large = map(size, _RADII)
    return Lamps(times, np.column_stack([centre[:, :2], up]), np.clip(0.4 * spread, small, large), total)


def _merge_sources(sources: heat_release.Sources, near: list[Path], block: float) -> heat_release.Sources:
    """Merge heat sources near the cameras within blocks."""
    kept = np.zeros(len(sources.power), bool)
    for view in near:
        low, high = view.position[:, :2].min(0) - _REACH, view.position[:, :2].max(0) + _REACH
        kept |= ((sources.position[:, :2] > low) & (sources.position[:, :2] < high)).all(axis=1)
    return heat_release.lights(sources.take(np.flatnonzero(kept)), block, len(kept) * 4 + 1)


def keyframe_times(shot: Shot) -> Array:
    """Return the model times of the lamps' keyframes: model times of the run, and both ends."""
    first, last, times = shot.frames.first, shot.frames.last, shot.run.times
    inside = times[(times > first) & (times < last)]
    if len(inside) > _KEYS - 2:
        inside = inside[np.linspace(0, len(inside) - 1, _KEYS - 2).round().astype(int)]
    return np.unique(np.concatenate([[first], inside, [last]]))


def _choose_centres(position: Array, weight: Array, count: int, seed: int) -> Array:
    """Choose at most `count` centres (n, 3) of weighted points: k-means++ (Arthur, Vassilvitskii 2007)."""
    random = np.random.default_rng(seed)
    centre = position[[int(np.argmax(weight))]]
    nearest = _squared_distances(position, centre)[:, 0]
    while len(centre) < count:
        chance = np.cumsum(weight * nearest)
        if not chance[-1] > 0.0:
            break
        chosen = min(int(np.searchsorted(chance, random.random() * chance[-1])), len(position) - 1)
        centre = np.concatenate([centre, position[[chosen]]])
        nearest = np.minimum(nearest, _squared_distances(position, centre[-1:])[:, 0])
    for _ in range(_ROUNDS):
        member = np.argmin(_squared_distances(position, centre), axis=1)
        total = np.bincount(member, weight, len(centre))
        some = total > 0.0
        for axis in range(3):
            moved = np.bincount(member, weight * position[:, axis], len(centre))
            centre[some, axis] = moved[some] / total[some]
    return centre


def _squared_distances(position: Array, centre: Array) -> Array:
    """Return squared horizontal distances (n, m), m2."""
    return (position[:, None, 0] - centre[None, :, 0]) ** 2 + (position[:, None, 1] - centre[None, :, 1]) ** 2
