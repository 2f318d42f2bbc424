"""Flames: position, flame length and tilt of points along the fire front, without Blender.

The front is the isoline on which the arrival time (fuel grid, bilinear between cells) equals the model time.
A point flames while the front passes it, so at any time the flaming points form a thin line.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from firetwin_core import constants, lod
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...shot.cameras.path import Path
from ...shot.fire import emissions, flame_noise, flame_state
from ...shot.fire.flame_size import CROWNS, SIGHT, flame_length, flame_temperature, flame_tilt
from ...shot.shot import Shot
from ...shot.terrain import noise
from ..forest import fire_effects
from ..forest.stand import Stand

_SPACING = ((2500.0, 8.0), (5000.0, 12.0), (SIGHT, 24.0))
"""Spacing (m) between points of a front with flames of at least `_TALL`, by distance (m) from the camera."""
_TALL = 12.0  # m
_FINEST = 0.25  # factor on these spacings for low flames
_FINE = 400_000  # points in the nearest cells that have the closest spacing at any distance; more are slow
_LINE = 1.5  # rows of points: a point flames while the front moves on by this many spacings
_LEADING = 1.0 / 3.0  # fraction of the residence time at full height, s
_LONGEST = 900.0  # s
_SIZES = 0.45  # standard deviation of the logarithm of flame lengths
_LENGTHS = (0.3, 75.0)  # m
_TORCH_SIGHT = 2500.0  # m
_TORCHES = 0.8  # fraction of the burning crowns that torch in a dense canopy
# slopes of the logit of a crown's chance by its clump's noise, and by its own (by eye)
_CLUMPED, _SINGLE = 5.0, 1.5
_AROUND = 250.0  # m around a cell that its flames and firebrands reach
_ACTIVE = 0.4, 0.8  # length of the front's flames over a tree's height at which it burns with them
_BRIEF = 0.4  # factor on the residence time of crowns in such flames (by eye)
_CROWN = 0.07  # area of a torching crown over the square of its height (assumed: 0.3 heights wide)
_LIFE = (0.0, 0.2, 0.6, 1.0), (0.25, 1.0, 1.0, 0.2)  # size of a flame by its age in residence times
_MEAN_LIFE = 0.765  # mean of that

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Points:
    """Flames of the shot, n of them; a flame is lit while 0 <= t - arrival_time < residence.

    Attributes
    ----------
    position
        (n, 3) m in the scene, on the ground.
    arrival_time, residence
        (n,) s.
    intensity
        (n,) fireline intensity, kW/m.
    length, width
        (n,) flame length and width, m.
    tilt
        (n,) angle from the vertical, radians, downwind.
    kelvin
        (n,) flame temperature.
    seed
        (n,) 0..1.
    heat
        (n,) W, heat release rate of flaming fuel at full size. The front's is the sum over lit flames, times
        their `life`; smouldering fuel is left out.
    crown
        (n,) height of the tree whose crown flames, m; 0 for flames of the front.
    """

    position: Array
    arrival_time: Array
    residence: Array
    intensity: Array
    length: Array
    width: Array
    tilt: Array
    kelvin: Array
    seed: Array
    heat: Array
    crown: Array

    def take(self, chosen: NDArray) -> Points:
        """Return a subset of the points."""
        return Points(*(getattr(self, field.name)[chosen] for field in fields(self)))

    def lit(self, time: float) -> NDArray[np.int64]:
        """Return the indices of flames that are lit at `time`."""
        age = time - self.arrival_time
        return np.flatnonzero((age >= 0.0) & (age < self.residence))


def life(age: Array) -> Array:
    """Return the part of its full size that a flame has at an age in residence times; 0 outside 0..1."""
    return np.where((age >= 0.0) & (age < 1.0), np.interp(age, *_LIFE), 0.0)


@dataclass(frozen=True)
class Layout:
    """Arrangement of the points along a front.

    Attributes
    ----------
    spacing
        Spacing (m) between points of a front with flames of at least `_TALL`, up to each distance (m) from
        the camera.
    nearest
        Number of points in the nearest cells that have the closest spacing at any distance.
    gaps
        True if fronts with low flames have gaps.
    """

    spacing: tuple[tuple[float, float], ...]
    nearest: int = 0
    gaps: bool = True


def front_flames(shot: Shot, grown: Stand | None = None, layout: Layout | None = None) -> Points:
    """Create the flames along the front at every time of the shot, at most `fire.budget` lit at once.

    Fireline intensity is H w R (Byram 1959), with the cell's fuel w and the rate of spread R from the
    gradient of the arrival time. With a stand, its torching crowns are added. Flames are wider in proportion
    to their spacing, so that the front's radiance stays the same. The default layout is for billboards.
    """
    layout = layout or Layout(_SPACING, _FINE)
    settings, ground, near = shot.settings, shot.ground, shot.perspective_paths
    first, last = shot.built_times[[0, -1]]
    row, column, spacing, distance, key = _candidates(shot, layout)
    arrival = ground.arrival_at(row, column)
    keep = (arrival <= last) & (arrival > first - _LONGEST)
    row, column, spacing, distance, arrival, key = (
        value[keep] for value in (row, column, spacing, distance, arrival, key)
    )
    speed = ground.spread(row, column)
    stands = shot.front.residence[np.rint(row).astype(np.int64), np.rint(column).astype(np.int64)]
    residence = _point_residence(spacing, speed, stands)
    random = np.array([noise.uniform(key[:, 0], key[:, 1], settings.seed + 500 + use) for use in range(3)])
    canopy, surface = (
        bilinear(f, row, column) for f in (ground.fields.canopy_fuel, ground.fields.surface_fuel)
    )
    fuel = canopy + surface
    lit = (arrival + residence > first) & (fuel > 0.05)
    row, column, arrival, speed, residence, stands, canopy, surface, spacing, distance = (
        value[lit]
        for value in (row, column, arrival, speed, residence, stands, canopy, surface, spacing, distance)
    )
    random = random[:, lit]
    place = ground.point(*ground.places(row, column)) if len(row) else np.empty((0, 3))
    intensity = constants.HEAT_OF_COMBUSTION / 1000.0 * (canopy + surface) * speed
    uneven = np.exp(_SIZES * noise.normal(random[0], random[1]))
    crowns = canopy > CROWNS
    even = flame_length(intensity, settings.fire.flame_length, crowns)
    unevenness = *place[:, :2].T, even, max(shot.front_scale, 0.3), settings.seed
    length = np.clip(even * uneven * flame_noise.flare_factor(*unevenness), *_LENGTHS)
    thin = lod.LevelTable().multiplier(distance) if len(distance) else np.ones(0)
    wind = float(np.hypot(*shot.wind))
    finest = _point_spacing(ground.cell, layout.spacing[0][1] * _relative_spacing(shot))[1]
    fewer = (spacing / finest) ** 2 * _point_residence(finest, speed, stands) / (residence * thin)
    points = Points(
        place,
        arrival,
        residence,
        intensity,
        length,
        np.clip(0.45 * length, 0.6 * finest, 1.6 * finest) * fewer,
        flame_tilt(wind, length),
        flame_temperature(intensity),
        random[2],
        _flaming_heat(canopy, surface, stands)
        * spacing**2
        / (residence * _MEAN_LIFE * thin * (1.0 - layout.gaps * flame_noise.gap_fraction(even))),
        np.zeros(len(length)),
    )
    kept = random[0] * 0.999 < thin
    if layout.gaps:
        kept &= flame_noise.gap_margin(*unevenness) > 0.0
    points = points.take(np.flatnonzero(kept))
    if grown is not None and settings.fire.torches:
        points = _concatenate([points, torching_crowns(shot, grown)])
    return _limit_to_budget(points, shot, near)


def _point_residence(spacing: Array | float, speed: Array, stands: Array) -> Array:
    """Return the residence (s) of points at a spacing (m) in a front with rate of spread `speed` (m/s).

    It is the time at full height, a fraction of the flames' residence time (s) at a point (`stands`).
    """
    return np.clip(_LINE * spacing / speed, _LEADING * stands, _LONGEST)


def _relative_spacing(shot: Shot) -> float:
    """Return point spacing relative to a crown fire's front: proportional to flame length."""
    ground, front = shot.bare_ground, shot.front
    passed = (ground.burned >= 0.5) & (np.abs(ground.arrival - shot.full.frames.middle) < _LONGEST + 900.0)
    if not passed.any():
        return 1.0
    fuel, canopy = ground.fields.surface_fuel[passed], ground.fields.canopy_fuel[passed]
    intensity = constants.HEAT_OF_COMBUSTION / 1000.0 * (fuel + canopy) * front.speed[passed]
    length = flame_length(intensity, shot.settings.fire.flame_length, canopy > CROWNS)
    return float(np.clip(np.percentile(length, 90.0) / _TALL, _FINEST, 1.0))


def _flaming_heat(canopy: Array, surface: Array, residence: Array) -> Array:
    """Return the heat (J/m2) of the fuel (kg/m2) that burns with flames, within the `residence` time (s).

    As in `heat_release.consumed`, fuel burns out exponentially, and smoulders after the flames.
    """
    floor = emissions.burn_out(surface, emissions.kind(surface, canopy))
    crowns = emissions.burn_out(canopy, emissions.CROWN)
    flaming = canopy * -np.expm1(-residence / crowns) + surface * -np.expm1(-residence / floor)
    return constants.HEAT_OF_COMBUSTION * flaming


def torching_crowns(shot: Shot, grown: Stand) -> Points:
    """Create flames of torching crowns when the front reaches them: tall, thin and short-lived.

    The fraction of burning crowns (`fire_effects`) that torch grows with canopy density. They torch in the
    clumps in which the front has its tallest flames, for half a minute to a minute, up to 1.05 to 1.5 times
    the tree's height (by eye). In an active crown fire they burn at once and briefly, in the tall flames of
    the front (Van Wagner 1977: passive and active crown fire). Crowns are as wide as the tree: one of a
    distant, thinned stand burns for those that it represents.
    """
    ground, (first, last) = shot.ground, shot.built_times[[0, -1]]
    near = np.flatnonzero((grown.distance < _TORCH_SIGHT) & (grown.height > 6.0))
    row, column = ground.under(grown.position[near])
    arrival = ground.arrival_at(row, column)
    canopy = bilinear(ground.fields.canopy_fuel, row, column)
    key = grown.key[near]
    single, size, late, seed = (
        noise.uniform(key[:, 0], key[:, 1], shot.settings.seed + 400 + k) for k in range(4)
    )
    luck = _luck(flame_noise.clumping(shot, *grown.position[near, :2].T), single)
    within = noise.smoothstep(*_ACTIVE, flame_state.even_length(shot, row, column) / grown.height[near])
    lit = (luck < _TORCHES * canopy / (canopy + 1.0)) & (arrival <= last)
    lit &= fire_effects.of_trees(shot, row, column, grown.height[near], grown.key[near]).torched
    residence = (30.0 + 30.0 * size) * (1.0 - (1.0 - _BRIEF) * within)
    arrival = arrival + 20.0 * late * (1.0 - within)
    chosen = np.flatnonzero(lit & (arrival + residence > first))
    row, column, size = row[chosen], column[chosen], size[chosen]
    height = grown.height[near[chosen]]
    length = np.clip(height * (1.05 + 0.45 * size), *_LENGTHS)
    intensity = constants.HEAT_OF_COMBUSTION / 1000.0 * canopy[chosen] * ground.spread(row, column)
    return Points(
        grown.position[near[chosen]],
        arrival[chosen],
        residence[chosen],
        intensity,
        length,
        0.45 * height * grown.width[near[chosen]],
        flame_tilt(float(np.hypot(*shot.wind)), 2.0 * length),
        flame_temperature(intensity),
        seed[chosen],
        constants.HEAT_OF_COMBUSTION * canopy[chosen] * _CROWN * height**2 / (residence[chosen] * _MEAN_LIFE),
        height,
    )


def _luck(clumps: Array, single: Array) -> Array:
    """Return numbers (n,), nearly uniform in 0..1, that are low in clumps (`flame_noise.clumping`)."""
    return 1.0 / (1.0 + np.exp(_CLUMPED * clumps + _SINGLE * (2.0 * single - 1.0)))


def _concatenate(parts: list[Points]) -> Points:
    return Points(*(np.concatenate([getattr(p, field.name) for p in parts]) for field in fields(Points)))


def _candidates(shot: Shot, layout: Layout) -> tuple[Array, Array, Array, Array, NDArray[np.int64]]:
    """Return rows, columns and spacing (m) of jittered points in cells that the front crosses in the shot.

    Also returns the distance (n,), m, from which their spacing follows, and integers (n, 2) that seed a
    point's random choices: its cell and its number in it. A point therefore does not depend on what else is
    visible.
    """
    ground, near, (first, last) = shot.ground, shot.perspective_paths, shot.built_times[[0, -1]]
    arrival = ground.arrival
    cells_lit = np.argwhere((arrival >= first - _LONGEST - 300.0) & (arrival <= last + 300.0))
    empty = np.empty(0)
    if len(cells_lit) == 0 or not near:
        return empty, empty, empty, empty, np.empty((0, 2), np.int64)
    centre = ground.point(*ground.places(cells_lit[:, 0].astype(float), cells_lit[:, 1].astype(float)))
    visible = shot.visibility.visible_mask(centre, max(ground.cell) + _AROUND, reach=SIGHT)
    cells_lit, distance = cells_lit[visible], _spacing_distance(shot, layout, centre[visible])
    parts = []
    before, close = 0.0, _relative_spacing(shot)
    for limit, wanted in layout.spacing:
        inside = (distance >= before) & (distance < limit)
        chosen = cells_lit[inside]
        before = limit
        count, spacing = _point_spacing(ground.cell, wanted * close)
        number = np.arange(count * count)
        cell = (chosen @ (ground.shape[1], 1))[:, None]

        def random(part: NDArray, use: int, cell: NDArray = cell) -> Array:
            seed = shot.settings.seed + 510 + use
            return np.stack([noise.uniform(cell, part, seed + axis) for axis in (0, 1)])

        # One shift per cell and one per point prevent rows of flames.
        at = (np.indices((count, count)).reshape(2, 1, -1) + random(number[:1], 0)) / count
        at = at + (random(number, 2) - 0.5) / count - 0.5
        parts.append(
            (
                (chosen[:, :1] + at[0]).ravel(),
                (chosen[:, 1:] + at[1]).ravel(),
                np.full(len(chosen) * count * count, spacing),
                np.repeat(distance[inside], count * count),
                np.stack(np.broadcast_arrays(cell, number), axis=-1).reshape(-1, 2),
            )
        )
    row, column, spacing, drawn, key = (np.concatenate([part[i] for part in parts]) for i in range(5))
    rows, columns = ground.shape
    return np.clip(row, 0.0, rows - 1.0), np.clip(column, 0.0, columns - 1.0), spacing, drawn, key


def _point_spacing(cell: tuple[float, float], wanted: float) -> tuple[int, float]:
    """Return the number of points along a cell's side, and their spacing (m), for a requested spacing (m)."""
    count = max(round(max(cell) / wanted), 1)
    return count, max(cell) / count


def _spacing_distance(shot: Shot, layout: Layout, centre: Array) -> Array:
    """Return the distance (n,), m, for the spacing in cells (n, 3): 0 in the nearest, up to some points.

    Visible flames are then mostly independent of the chunk of the film and of what else is built.
    """
    distance = shot.visibility.lod_distance(centre)
    count, _ = _point_spacing(shot.ground.cell, layout.spacing[0][1] * _relative_spacing(shot))
    distance[np.argsort(distance, kind="stable")[: layout.nearest // count**2]] = 0.0
    return distance


def _limit_to_budget(points: Points, shot: Shot, views: list[Path]) -> Points:
    """Drop the farthest flames until no frame lights more than `fire.budget`, unless culling is off."""
    if shot.visibility.unculled:
        return points
    budget = max(shot.settings.fire.budget, 0)
    keep = np.ones(len(points.arrival_time), bool)
    for index, time in zip(shot.built_frames, shot.built_times, strict=True):
        lit = points.lit(float(time))
        lit = lit[keep[lit]]
        if len(lit) > budget:
            eyes = np.array([view.position[index] for view in views]) if views else np.zeros((1, 3))
            near = lod.select_nearest(points.position[lit], np.ascontiguousarray(eyes), budget)
            drop = np.ones(len(lit), bool)
            drop[near] = False
            keep[lit[drop]] = False
    return points.take(np.flatnonzero(keep))
