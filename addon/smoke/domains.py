"""Flow domains: a box around the fire, and a finer nest where cameras look. Needs no Blender.

Lengths and times here apply to cells of `smoke_scale.REFERENCE`; they scale with the shot's cells.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path as FilePath

import numpy as np
from firetwin_core import constants
from numpy.typing import NDArray

from ..shot.cameras.path import Path
from ..shot.fire.fire import Fire
from ..shot.fire.smoke_scale import FINER, LEVELS, NEST, Scale
from ..shot.shot import Shot
from . import atmosphere, snapshots

LEAD = 600.0  # s, spin-up of the nest before the first frame, in which its own eddies develop
_LEVELS, _NEST_LEVELS = (
    (60.0, 270.0, LEVELS[0]),
    (36.0, 186.0, LEVELS[1]),
)  # depth of the lowest level (m), growth to the highest, number of levels
_MARGIN = 5000.0  # m around the burning area, for the fire's inflow
_DOWNWIND = (6000.0, 15_000.0)  # m, downwind extent, least and most
_WIDEST = 130_000.0  # m, side limit; smoke of more distant burning cells is left out
_SHARE = 0.01  # fraction of the heat that may lie outside of the bounds on each side
_NEST = NEST  # cells along a side: 12 km
_MAX_COVERED = 0.8  # fire extent / nest side, up to which the nest is centred on the complete fire
_NEST_ROUND = 6000.0  # m; radius of the heat on which the nest is centred, near the camera's target
_NEST_SEEN = 60_000.0  # m; the nest adds no visible detail for cameras farther away
_NEST_SWATH = 20_000.0  # m; wider pictures from above show more of the domain than of the nest
_SNAP = 1000.0  # m; grid for the nest's position, so that small camera changes do not move it
_TOP = 600.0, 2.0  # m, and factor on the plume rise: least height of the box
_MIN_WIND = 1.0  # m/s, lower limit of the wind in the plume rise
_SIZE_FACTORS = (1, 2, 3, 5)  # factors of the side lengths, for the fast transforms

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Box:
    """Grid of square cells of `spacing` m on levels (nz + 1,), m above ground; `corner` has least x and y."""

    levels: tuple[float, ...]
    shape: tuple[int, int]
    spacing: float
    corner: tuple[float, float]

    def plain(self) -> list[object]:
        """Return the JSON form."""
        return [list(self.levels), list(self.shape), self.spacing, list(self.corner)]

    def middles(self) -> tuple[Array, Array]:
        """Return cell centres: x (nx,) of columns and y (ny,) of rows, m."""
        x, y = (
            low + (np.arange(n) + 0.5) * self.spacing
            for low, n in zip(self.corner, self.shape[::-1], strict=True)
        )
        return x, y

    def contains(self, points: Array) -> NDArray[np.bool_]:
        """Return which points (n, 2 or more), m, are between cell centres, where a flow takes sources."""
        cell = (points[:, :2] - self.corner) / self.spacing - 0.5
        return np.all((cell >= 0.0) & (cell < np.array(self.shape[::-1]) - 1.0), axis=1)

    @property
    def high(self) -> tuple[float, float]:
        """Corner of greatest x and y."""
        x, y = (low + n * self.spacing for low, n in zip(self.corner, self.shape[::-1], strict=True))
        return x, y


@dataclass(frozen=True)
class Domain:
    """Flow domain: box, ground height in its cells (rows, columns), m, and folder of its snapshots.

    Levels are terrain-following relative to the mean height of the outermost box. They flatten towards that
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
        """Compute the heights of cell centres (nz, rows, columns), m."""
        levels = np.array(self.box.levels)
        middles = 0.5 * (levels[1:] + levels[:-1])[:, None, None]
        return self.mean + middles + (self.ground - self.mean) * np.maximum(1.0 - middles / self.top, 0.0)

    def volumes(self) -> Array:
        """Compute the volumes of cells (nz, rows, columns), m3; over high ground they are thinner.

        Smoke (kg/m3) of a snapshot times the volumes of its block sums to its airborne mass.
        """
        return np.diff(self.box.levels)[:, None, None] * self.thickness() * self.box.spacing**2

    def thickness(self) -> Array:
        """Compute the depth of cells relative to their levels (rows, columns)."""
        return 1.0 - (self.ground - self.mean) / self.top

    def snapshot_path(self, frame: int) -> FilePath:
        """Return the snapshot file of a frame."""
        return self.folder / f"moment_{frame:06d}.npz"

    def has(self, frame: int) -> bool:
        """Return whether a frame's snapshot exists."""
        return snapshots.is_complete(self.snapshot_path(frame), (len(self.box.levels) - 1, *self.box.shape))


def outer_box(shot: Shot) -> Box | None:
    """Return a box around all fire from spin-up to the last frame; None without fire.

    It is independent of the cameras.
    """
    length, cell = shot.scale.length, shot.scale.cell
    begin = shot.frames.first - shot.spin_up
    bounds = [_bounds(shot.fire, time) for time in np.linspace(begin, shot.frames.last, 5)]
    extents = np.array([each for each in bounds if each is not None])
    if len(extents) == 0:
        return None
    low, high = extents[:, 0].min(axis=0) - length(_MARGIN), extents[:, 1].max(axis=0) + length(_MARGIN)
    middle = np.array(shot.wind)
    speed = float(np.hypot(*middle))
    if speed > 0.0:
        time = shot.spin_up + shot.frames.last - shot.frames.first
        least, most = (length(way) for way in _DOWNWIND)
        way = np.clip(1.5 * atmosphere.WIND * speed * time, least, most) * middle / speed
        low, high = low + np.minimum(way, 0.0), high + np.maximum(way, 0.0)
    middle, half = 0.5 * (low + high), np.minimum(0.5 * (high - low), 0.5 * length(_WIDEST))
    low, high = middle - half, middle + half
    corner = np.floor(low / cell) * cell
    columns, rows = (_fast_size(int(np.ceil(side / cell))) for side in high - corner)
    levels = _levels(_LEVELS, shot.scale.ratio, _height_fraction(shot))
    return Box(levels, (rows, columns), cell, (float(corner[0]), float(corner[1])))


def nest_box(shot: Shot, around: Box) -> Box | None:
    """Return a nested box around the heat in view; None without a near camera or without spin-up time.

    If all heat fits, the nest is centred on it for any camera, so that cameras share the solution.
    """
    length = shot.scale.length
    near = [view.target.mean(axis=0) for view in shot.paths if _sees_nest(view, shot.scale)]
    if not near or not shot.scale.nested:
        return None
    fine, snap = around.spacing / FINER, length(_SNAP)
    side = _NEST * fine
    low, high = heat_bounds(shot)
    covered = bool(np.all(high - low < _MAX_COVERED * side))
    middle = 0.5 * (low + high) if covered else _heat_centre(shot, np.mean(near, axis=0)[:2])
    if middle is None:
        return None
    room = 4.0 * around.spacing
    corner = np.round((middle - 0.5 * side) / snap) * snap
    corner = np.clip(corner, np.array(around.corner) + room, np.array(around.high) - side - room)
    corner = np.round(corner / around.spacing) * around.spacing
    if np.any(corner < np.array(around.corner) + room):  # the box is only slightly wider than the nest
        return None
    levels = _levels(_NEST_LEVELS, shot.scale.ratio, _height_fraction(shot))
    return Box(levels, (_NEST, _NEST), fine, (float(corner[0]), float(corner[1])))


def on_ground(shot: Shot, boxes: list[Box], folder: FilePath = FilePath()) -> list[Domain]:
    """Return the domains of a box and of its nest over smoothed ground, with their snapshots in a folder."""
    if not boxes:
        return []
    grounds = [smooth_ground(shot, box, 8 if number else 2) for number, box in enumerate(boxes)]
    mean, top = float(grounds[0].mean()), boxes[0].levels[-1]
    return [
        Domain(box, ground, mean, top, folder, shot.scale) for box, ground in zip(boxes, grounds, strict=True)
    ]


def smooth_ground(shot: Shot, box: Box, smoothings: int) -> Array:
    """Compute smoothed ground heights in a box's cells (rows, columns), m."""
    x, y = box.middles()
    height = shot.bare_ground.up(np.tile(x, len(y)), np.repeat(y, len(x))).reshape(len(y), len(x))
    for _ in range(smoothings):
        for axis in (0, 1):
            edged = np.pad(height, [(1, 1) if a == axis else (0, 0) for a in (0, 1)], "edge")
            count = height.shape[axis]
            low, here, high = (edged.take(range(k, k + count), axis) for k in range(3))
            height = 0.25 * (low + high) + 0.5 * here
    return height


def heat_bounds(shot: Shot) -> tuple[Array, Array]:
    """Return bounds (x, y) of the shot's heat without outliers, lowest and highest, m; infinite if none."""
    bounds = [_bounds(shot.fire, time) for time in np.linspace(shot.frames.first, shot.frames.last, 5)]
    extents = np.array([each for each in bounds if each is not None])
    if len(extents) == 0:
        return np.zeros(2), np.full(2, np.inf)
    return extents[:, 0].min(axis=0), extents[:, 1].max(axis=0)


def _heat_centre(shot: Shot, target: Array) -> Array | None:
    """Return the centre (x, y) of the heat around the source nearest to `target`; None without heat."""
    sources = shot.fire.sources(shot.frames.middle)
    if len(sources.power) == 0:
        return None
    place, power = sources.position[:, :2], sources.power
    nearest = place[np.argmin(np.hypot(*(place - target).T))]
    close = np.hypot(*(place - nearest).T) < shot.scale.length(_NEST_ROUND)
    return np.average(place[close], axis=0, weights=power[close])


def _sees_nest(view: Path, scale: Scale) -> bool:
    """Return whether the nest adds visible detail for a camera."""
    if not view.perspective:
        return 2.0 * view.half[0] < scale.length(_NEST_SWATH)
    return np.hypot(*(view.position - view.target).mean(axis=0)[:2]) < scale.length(_NEST_SEEN)


def _height_fraction(shot: Shot) -> float:
    """Return the share of the full domain height that the plume needs.

    At full height, the plume of a small fire would span few levels. Plume rise is 2.6 (F / (U s))^(1/3) (G.
    A. Briggs 1975, "Plume rise predictions", AMS Lectures on Air Pollution), with buoyancy flux F = g Q / (pi
    cp rho T), at the daytime stability.
    """
    times = np.linspace(shot.frames.first, shot.frames.last, 5)
    power = max(float(shot.fire.sources(time).power.sum()) for time in times)
    wind = max(atmosphere.WIND * float(np.hypot(*shot.wind)), _MIN_WIND)
    rise = 2.6 * np.cbrt(constants.BUOYANCY_FLUX * power / (wind * atmosphere.STABILITY))
    lowest, growth, count = _LEVELS
    return min((_TOP[0] + _TOP[1] * rise) / ((lowest + 0.5 * growth) * count), 1.0)


def _levels(depths: tuple[float, float, int], ratio: float, fraction: float) -> tuple[float, ...]:
    """Return levels of linearly growing depth, m above ground; the lowest scales with the cells."""
    lowest, growth, count = depths
    top = (lowest + 0.5 * growth) * count * fraction
    lowest *= ratio
    growth = max(2.0 * (top / count - lowest), 0.0)
    k = np.arange(count + 1)
    return tuple(float(each) for each in lowest * k + 0.5 * growth / count * k * k)


def _bounds(fire: Fire, time: float) -> Array | None:
    """Return bounds (2, 2), lowest and highest x and y, of all heat without outliers, m."""
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


def _fast_size(cells: int) -> int:
    """Round up to an even cell count of at least 48 with prime factors 2, 3 and 5, for fast transforms."""
    for count in range(max(cells, 48), 10 * max(cells, 48)):
        left = count
        for factor in _SIZE_FACTORS[1:]:
            while left % factor == 0:
                left //= factor
        if left == 1 and count % 2 == 0:
            return count
    raise AssertionError("there is always a power of two")
