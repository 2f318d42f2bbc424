"""Where a flow of smoke is solved: a box round what burns, and a finer one where cameras look. No Blender.

Lengths and times here are those at cells of `scale.REFERENCE`; they go with the shot's cells.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path as FilePath

import numpy as np
from numpy.typing import NDArray

from ..shot.cameras.path import Path
from ..shot.fire.fire import Fire
from ..shot.shot import Shot
from ..shot.smoke_scale import FINER, LEVELS, NEST, Scale
from . import atmosphere, snapshots

LEAD = 600.0  # s that the nest is solved before the first frame: its own eddies need them
_LEVELS, _NEST_LEVELS = (
    (60.0, 270.0, LEVELS[0]),
    (36.0, 186.0, LEVELS[1]),
)  # lowest m, growth to the highest, count
_MARGIN = 5000.0  # m round what burns: air that the fire draws in
_DOWNWIND = (6000.0, 15_000.0)  # m that smoke is followed
_WIDEST = 130_000.0  # m along a side; smoke of what burns farther out is left out
_SHARE = 0.01  # of the heat that may lie outside of the middle on each side
_NEST = NEST  # cells along a side: 12 km
_COVERED = 0.8  # of a nest's side that the heat in its middle may be long
_NEST_ROUND = 6000.0  # m; the nest's middle is that of the heat so near to what a camera looks at
_NEST_SEEN = 60_000.0  # m; cameras farther away see nothing that the nest adds
_NEST_SWATH = 20_000.0  # m; pictures from straight above that are wider show more rest than nest
_SNAP = 1000.0  # m; a nest stays where it is when a camera moves a little
_TOP = 600.0, 2.0  # m, and times the rise of a plume: how high the box is at least
_CALM = 1.0  # m/s, the least wind that a plume's rise is reckoned with
_EVEN = (1, 2, 3, 5)  # sides have no other factors, for the transforms

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Box:
    """Square cells of `spacing` m on levels (nz + 1,) m above ground, from the corner of least x and y."""

    levels: tuple[float, ...]
    shape: tuple[int, int]
    spacing: float
    corner: tuple[float, float]

    def plain(self) -> list[object]:
        """As JSON can carry it."""
        return [list(self.levels), list(self.shape), self.spacing, list(self.corner)]

    def middles(self) -> tuple[Array, Array]:
        """Columns' x (nx,) and rows' y (ny,) in the cells' middles, m."""
        return tuple(
            low + (np.arange(n) + 0.5) * self.spacing
            for low, n in zip(self.corner, self.shape[::-1], strict=True)
        )

    @property
    def high(self) -> tuple[float, float]:
        """The corner of greatest x and y."""
        return tuple(low + n * self.spacing for low, n in zip(self.corner, self.shape[::-1], strict=True))


@dataclass(frozen=True)
class Domain:
    """A box in which a flow is solved: the ground in it (rows, columns), m, and the folder of its snapshots.

    Levels follow the ground about its mean in the outermost box. They follow it less and less up to that
    box's top, m.
    """

    box: Box
    ground: Array
    mean: float
    top: float
    folder: FilePath
    scale: Scale

    @property
    def cells(self) -> int:
        """Number of cells."""
        return math.prod(self.box.shape) * (len(self.box.levels) - 1)

    def heights(self) -> Array:
        """Heights of cells' middles (nz, rows, columns), m."""
        levels = np.array(self.box.levels)
        middles = 0.5 * (levels[1:] + levels[:-1])[:, None, None]
        return self.mean + middles + (self.ground - self.mean) * np.maximum(1.0 - middles / self.top, 0.0)

    def snapshot_path(self, frame: int) -> FilePath:
        """The file of a frame's snapshot."""
        return self.folder / f"moment_{frame:06d}.npz"

    def has(self, frame: int) -> bool:
        """Whether a frame's snapshot is kept."""
        return snapshots.is_whole(self.snapshot_path(frame), (len(self.box.levels) - 1, *self.box.shape))


def whole(shot: Shot) -> Box | None:
    """The box round what burns from the flow's beginning to the last frame; None where nothing does.

    It does not depend on the cameras.
    """
    length, cell = shot.scale.length, shot.scale.cell
    begin = shot.frames.first - shot.spin_up
    bounds = [_bounds(shot.fire, time) for time in np.linspace(begin, shot.frames.last, 5)]
    found = np.array([each for each in bounds if each is not None])
    if len(found) == 0:
        return None
    low, high = found[:, 0].min(axis=0) - length(_MARGIN), found[:, 1].max(axis=0) + length(_MARGIN)
    middle = np.array(shot.wind)
    speed = float(np.hypot(*middle))
    if speed > 0.0:
        time = shot.spin_up + shot.frames.last - shot.frames.first
        most = [length(way) for way in _DOWNWIND]
        way = np.clip(1.5 * atmosphere.WIND * speed * time, *most) * middle / speed
        low, high = low + np.minimum(way, 0.0), high + np.maximum(way, 0.0)
    middle, half = 0.5 * (low + high), np.minimum(0.5 * (high - low), 0.5 * length(_WIDEST))
    low, high = middle - half, middle + half
    corner = np.floor(low / cell) * cell
    columns, rows = (_even(int(np.ceil(side / cell))) for side in high - corner)
    levels = _levels(_LEVELS, shot.scale.ratio, _height_fraction(shot))
    return Box(levels, (rows, columns), cell, (float(corner[0]), float(corner[1])))


def nest(shot: Shot, around: Box) -> Box | None:
    """The finer box round the heat that the cameras look at; None where no camera is near, or no time.

    Heat that fits into it lies in its middle, whatever the cameras look at: they share what is solved.
    """
    length = shot.scale.length
    near = [view.target.mean(axis=0) for view in shot.paths if _sees_nest(view, shot.scale)]
    if not near or not shot.scale.nested:
        return None
    fine, snap = around.spacing / FINER, length(_SNAP)
    side = _NEST * fine
    low, high = _burning(shot)
    covered = bool(np.all(high - low < _COVERED * side))
    middle = 0.5 * (low + high) if covered else _looked_at(shot, np.mean(near, axis=0)[:2])
    if middle is None:
        return None
    room = 4.0 * around.spacing
    corner = np.round((middle - 0.5 * side) / snap) * snap
    corner = np.clip(corner, np.array(around.corner) + room, np.array(around.high) - side - room)
    corner = np.round(corner / around.spacing) * around.spacing
    if np.any(corner < np.array(around.corner) + room):  # the box is hardly wider than the nest
        return None
    levels = _levels(_NEST_LEVELS, shot.scale.ratio, _height_fraction(shot))
    return Box(levels, (_NEST, _NEST), fine, (float(corner[0]), float(corner[1])))


def smooth_ground(shot: Shot, box: Box, smoothings: int) -> Array:
    """Smoothed height of the ground in a box's cells (rows, columns), m."""
    x, y = box.middles()
    height = shot.bare_ground.up(np.tile(x, len(y)), np.repeat(y, len(x))).reshape(len(y), len(x))
    for _ in range(smoothings):
        for axis in (0, 1):
            edged = np.pad(height, [(1, 1) if a == axis else (0, 0) for a in (0, 1)], "edge")
            count = height.shape[axis]
            low, here, high = (edged.take(range(k, k + count), axis) for k in range(3))
            height = 0.25 * (low + high) + 0.5 * here
    return height


def _burning(shot: Shot) -> tuple[Array, Array]:
    """Lowest and highest x and y of all heat but a little in the shot, m. There is some."""
    bounds = [_bounds(shot.fire, time) for time in np.linspace(shot.frames.first, shot.frames.last, 5)]
    found = np.array([each for each in bounds if each is not None])
    if len(found) == 0:
        return np.zeros(2), np.full(2, np.inf)
    return found[:, 0].min(axis=0), found[:, 1].max(axis=0)


def _looked_at(shot: Shot, target: Array) -> Array | None:
    """The middle (x, y) of the heat round that which is nearest to a place; None where there is none."""
    sources = shot.fire.sources(shot.frames.middle)
    if len(sources.power) == 0:
        return None
    place, power = sources.position[:, :2], sources.power
    nearest = place[np.argmin(np.hypot(*(place - target).T))]
    close = np.hypot(*(place - nearest).T) < shot.scale.length(_NEST_ROUND)
    return np.average(place[close], axis=0, weights=power[close])


def _sees_nest(view: Path, scale: Scale) -> bool:
    """Whether a camera shows what the nest adds."""
    if not view.perspective:
        return 2.0 * view.half[0] < scale.length(_NEST_SWATH)
    return np.hypot(*(view.position - view.target).mean(axis=0)[:2]) < scale.length(_NEST_SEEN)


def _height_fraction(shot: Shot) -> float:
    """Fraction of the full height that the plume needs. A small fire's plume would have few levels in all.

    It rises by 2.6 (F / (U s))^(1/3) (G. A. Briggs 1975, "Plume rise predictions", AMS Lectures on Air
    Pollution), with F = g Q / (pi cp rho T), at the stratification of air by day.
    """
    times = np.linspace(shot.frames.first, shot.frames.last, 5)
    power = max(float(shot.fire.sources(time).power.sum()) for time in times)
    wind = max(atmosphere.WIND * float(np.hypot(*shot.wind)), _CALM)
    rise = 2.6 * np.cbrt(atmosphere.BUOYANCY * power / (wind * atmosphere.STABILITY))
    lowest, growth, count = _LEVELS
    return min((_TOP[0] + _TOP[1] * rise) / ((lowest + 0.5 * growth) * count), 1.0)


def _levels(depths: tuple[float, float, int], ratio: float, fraction: float) -> tuple[float, ...]:
    """Levels whose depth grows evenly, m above ground: the lowest as cells are, the highest as it must."""
    lowest, growth, count = depths
    top = (lowest + 0.5 * growth) * count * fraction
    lowest *= ratio
    growth = max(2.0 * (top / count - lowest), 0.0)
    k = np.arange(count + 1)
    return tuple(float(each) for each in lowest * k + 0.5 * growth / count * k * k)


def _bounds(fire: Fire, time: float) -> Array | None:
    """Lowest and highest x and y (2, 2) of all heat but a little, m."""
    sources = fire.sources(time)
    if sources.power.sum() <= 0.0:
        return None
    sides = []
    for axis in (0, 1):
        order = np.argsort(sources.position[:, axis], kind="stable")
        share = np.cumsum(sources.power[order])
        ends = np.searchsorted(share, share[-1] * np.array([_SHARE, 1.0 - _SHARE]))
        sides.append(sources.position[order[np.minimum(ends, len(order) - 1)], axis])
    return np.array(sides).T


def _even(cells: int) -> int:
    """The next number of cells, at least 48, that transforms like: 2, 3 and 5 are its only factors."""
    for count in range(max(cells, 48), 10 * max(cells, 48)):
        left = count
        for factor in _EVEN[1:]:
            while left % factor == 0:
                left //= factor
        if left == 1 and count % 2 == 0:
            return count
    raise AssertionError("there is always a power of two")
