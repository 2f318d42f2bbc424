"""Active front of a shot for camera placement: positions, rate of spread, and size."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..run import burning, extent, sun
from ..shot.shot import Shot
from ..shot.terrain.terrain import NEVER, UNKNOWN, Terrain, box
from .coarse_smoke import CoarseSmoke

_QUANTILES = (
    0.1,
    0.5,
    0.9,
)  # quantiles of the burned fuel in the window: times at which the front is sampled
_ABOVE = 2.0  # m above the ground, of the flames (assumed)
_SPREAD = (0.001, 5.0)  # m/s
_STILL = 0.5  # m/s; a weaker wind has no direction
_ONE_WAY = 0.3  # length of the mean spread vector over mean speed, below which the fire has no head (assumed)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MovingFront:
    """Front positions at a few times of the window; empty without fire.

    Attributes
    ----------
    frames
        (m,) indices of the frames nearest to these times, from 0.
    point, velocity, moment
        For n points: (n, 3) m in the scene, a little above the ground; (n, 2) m/s east and north; and (n,)
        index of the time.
    low, high
        (2,) corners of the area burned by the end of the window, m.
    fire
        Diagonal of the largest fire, m; `size` covers all fires.
    runs
        True if any fuel ignites in the window; else the points burn nearest in time to it.
    """

    shot: Shot
    frames: NDArray[np.int64]
    point: Array
    velocity: Array
    moment: NDArray[np.int64]
    low: Array
    high: Array
    fire: float
    runs: bool

    @property
    def ground(self) -> Terrain:
        """Terrain without detail near cameras."""
        return self.shot.bare_ground

    @cached_property
    def size(self) -> float:
        """Diagonal of the burned area, m, at least two cells of the fuel grid."""
        return max(float(np.hypot(*(self.high - self.low))), 2.0 * max(self.ground.cell))

    @cached_property
    def wind(self) -> Array:
        """Unit vector (2,) of smoke drift: downwind, or along the spread without wind data; or 0."""
        wind = np.array(self.shot.wind)
        speed = float(np.hypot(*wind))
        if speed > _STILL:
            return wind / speed
        return self.heading

    @cached_property
    def smoke(self) -> CoarseSmoke:
        """Smoke of a coarse flow at these times."""
        return CoarseSmoke(self.shot, self.frames)

    @cached_property
    def sun(self) -> tuple[float, float]:
        """Azimuth and elevation of the sun in the middle of the window, degrees."""
        return sun.position(self.shot.run, self.shot.frames.middle)

    @property
    def night(self) -> bool:
        """Return whether the sun is below the horizon in the middle of the window."""
        return self.sun[1] < 0.0

    @cached_property
    def heading(self) -> Array:
        """Unit vector (2,) of the fire's course; 0 if it spreads evenly."""
        if len(self.velocity) == 0:
            return np.zeros(2)
        resultant = self.velocity.mean(axis=0)
        length = float(np.hypot(*resultant))
        return (
            resultant / length
            if length > _ONE_WAY * float(np.hypot(*self.velocity.T).mean())
            else np.zeros(2)
        )

    @cached_property
    def crowns(self) -> bool:
        """Return whether the burning area has trees in it or around it."""
        fields = self.ground.fields
        if len(self.point) == 0:
            return False
        row, column = (v.astype(np.int64) for v in self.ground.under(self.point))
        return float(np.mean(fields.canopy_fuel[row, column] > 0.01)) > 0.05


def some(chosen: NDArray[np.int64], most: int) -> NDArray[np.int64]:
    """Even subset of at most `most` indices."""
    return chosen[np.unique(np.linspace(0, len(chosen) - 1, min(len(chosen), most)).round().astype(np.int64))]


def find_front(shot: Shot) -> MovingFront:
    """Sample the front of a shot."""
    ground, frames = shot.bare_ground, shot.frames
    burned = ground.arrival <= max(frames.last, frames.first + 1.0)
    within = box(burned)
    if within is None:
        return _nothing(shot)
    inside = ground.arrival[burned]
    inside = inside[inside >= frames.first]
    times = np.quantile(inside, _QUANTILES) if len(inside) else np.array([frames.middle])
    samples = [front_at(ground, float(time)) for time in times]
    moment = np.repeat(np.arange(len(times)), [len(part[0]) for part in samples])
    index = np.clip(np.round((times - frames.first) / max(frames.step, 1.0e-9)), 0, frames.count - 1)
    point, velocity = (np.concatenate(parts) for parts in zip(*samples, strict=True))
    return MovingFront(
        shot,
        index.astype(np.int64),
        point,
        velocity,
        moment,
        *_corners(ground, *within),
        extent.largest(burned[within], ground.cell),
        len(inside) > 0,
    )


def _nothing(shot: Shot) -> MovingFront:
    """Front of a run without fire, with the corners of its grid."""
    whole = slice(shot.bare_ground.fields.margin, -shot.bare_ground.fields.margin or None)
    none = np.zeros(0, np.int64)
    corners = _corners(shot.bare_ground, whole, whole)
    return MovingFront(shot, none, np.empty((0, 3)), np.empty((0, 2)), none, *corners, 0.0, False)


def _corners(ground: Terrain, rows: slice, columns: slice) -> tuple[Array, Array]:
    """Corners (2,) of rows and columns of the grid, least and greatest x and y, m."""
    fields = ground.fields
    latitude, longitude = fields.latitude[rows][[0, -1]], fields.longitude[columns][[0, -1]]
    place = ground.frame.forward_grid(latitude, longitude, np.zeros((2, 2))).reshape(-1, 3)
    return place[:, :2].min(axis=0), place[:, :2].max(axis=0)


def front_at(ground: Terrain, time: float) -> tuple[Array, Array]:
    """Find positions (n, 3) and velocities (n, 2) of the cells at the front, at the nearest model time."""
    near = box(ground.arrival < NEVER, more=2)
    if near is None:
        return np.empty((0, 3)), np.empty((0, 2))
    arrival, burn_time = ground.arrival[near], ground.burn_time[near]
    row, column = np.nonzero(arrival < NEVER)
    crossing = burning.crossing(np.where(arrival < NEVER, arrival, np.nan), row, column)
    late = np.abs(arrival[row, column] - time) / crossing
    here = np.flatnonzero(late <= 0.5)
    if len(here) == 0:
        here = np.argsort(late, kind="stable")[:20]
    row, column = row[here], column[here]
    known = np.where(burn_time < UNKNOWN, burn_time, np.nan)
    slope = np.stack(
        [_slope(known, row, column, axis, size) for axis, size in ((1, ground.cell[1]), (0, ground.cell[0]))],
        axis=-1,
    )
    steep = np.maximum(np.hypot(*slope.T), 1.0e-9)
    velocity = slope / steep[:, None] * np.clip(1.0 / steep, *_SPREAD)[:, None]
    row, column = row + near[0].start, column + near[1].start
    fields = ground.fields
    point = ground.frame.forward(
        fields.latitude[row], fields.longitude[column], fields.elevation[row, column] + _ABOVE
    )
    return point, velocity


def _slope(time: Array, row: NDArray[np.int64], column: NDArray[np.int64], axis: int, size: float) -> Array:
    """Gradient (n,) of arrival times along an axis, s/m: central differences, one-sided at unknown values."""
    ends = []
    for step in (-1, 1):
        at = [row, column]
        at[axis] = np.clip(at[axis] + step, 0, time.shape[axis] - 1)
        ends.append(time[at[0], at[1]])
    here = time[row, column]
    sides = np.stack([here - ends[0], ends[1] - here])
    with np.errstate(invalid="ignore"):
        known = np.isfinite(sides)
        return np.where(known, sides, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1) / size
