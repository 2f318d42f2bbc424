"""Divisions of a run's front: sectors around the centre of the fire, with hourly front lengths."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from ..ellipsoid import metres_per_degree
from ..run import front
from ..run.arrival_grid import ArrivalGrid
from . import control_line
from .control_line import USUAL, Line, LineOptions

MOST = 26  # divisions, named by letters
HOUR = 3600.0  # s

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Divisions:
    """Sectors of equal angle around a centre, clockwise from north.

    Attributes
    ----------
    centre
        Latitude and longitude, degrees.
    hours
        (t,) hours after the order: 1, 2, ...
    perimeter
        (k, t) length of the control line in each sector, m, without slopes.
    detailed
        (k, t) length of the outer front in all detail, m.
    burned
        (k, t) burned area in each sector, m2.
    place
        (k, 2) latitude and longitude of the middle of the first front in each sector, degrees; NaN: none.
    lines
        Control line at each hour.
    """

    centre: tuple[float, float]
    hours: Array
    perimeter: Array
    detailed: Array
    burned: Array
    place: Array
    lines: tuple[Line, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Letters; they are not the ICS divisions of an incident."""
        return tuple(chr(ord("A") + k) for k in range(len(self.perimeter)))

    def bearings(self, k: int) -> tuple[float, float]:
        """Return the bearings that limit a division, degrees clockwise from north."""
        width = 360.0 / len(self.perimeter)
        return k * width, (k + 1) * width


def divide(run: Run, start: float, hours: int, count: int, options: LineOptions = USUAL) -> Divisions:
    """Divide the control line around a run's fire.

    Parameters
    ----------
    start
        Model time of the order, s.
    hours
        Number of hours after it.
    count
        Number of divisions, 1 to `MOST`.
    options
        Detail of the control line.
    """
    grid, reach = ArrivalGrid.from_run(run), front.reach(run)
    centre = _centre(grid, start)
    rows, columns = np.meshgrid(grid.latitude, grid.longitude, indexing="ij")
    cell = sector(*_to_metres(rows, columns, centre), count)
    after = np.arange(1, hours + 1, dtype=np.float64)
    perimeter, detailed, burned = (np.zeros((count, hours)) for _ in range(3))
    place, lines = np.full((count, 2), np.nan), []
    for t, moment in enumerate(start + HOUR * after):
        lines.append(control_line.trace(grid, reach, moment, options))
        perimeter[:, t], middle = front_lengths(*lines[-1], centre, count)
        detailed[:, t], _ = front_lengths(*reach.line(moment), centre, count)
        place = np.where(np.isnan(place), middle, place)
        burned[:, t] = np.bincount(cell.ravel(), (grid.areas * grid.burned(moment)).ravel(), count)
    return Divisions(centre, after, perimeter, detailed, burned, place, tuple(lines))


def ignition_time(run: Run) -> float:
    """Return the model time (s) at which the fire of a run begins; infinite without fire."""
    return _first_arrival(ArrivalGrid.from_run(run))


def _first_arrival(grid: ArrivalGrid) -> float:
    return float(np.min(grid.arrival, initial=np.inf, where=np.isfinite(grid.arrival)))


def sector(east: ArrayLike, north: ArrayLike, count: int) -> NDArray[np.int64]:
    """Return the sector, numbered clockwise from north, of points in metres from the centre."""
    bearing = np.arctan2(east, north) / (2.0 * np.pi) % 1.0
    return np.minimum((bearing * count).astype(np.int64), count - 1)


def front_lengths(
    latitude: Array, longitude: Array, after: NDArray[np.int64], centre: tuple[float, float], count: int
) -> tuple[Array, Array]:
    """Compute the length (k,) of closed lines in each sector, m, and the middle (k, 2) of each part, degrees.

    A segment belongs to the sector of its middle. Lines around unburned islands are omitted.

    Parameters
    ----------
    latitude, longitude, after
        Points (n,) of the lines and the index of the next point, with the burned side on the left.
    """
    outer = outer_points(*_to_metres(latitude, longitude, centre), after)
    ends = np.stack([latitude, longitude], axis=-1)[np.stack([outer, after[outer]])]
    (middle, way) = (0.5 * (ends[0] + ends[1]), ends[1] - ends[0])
    north, east = metres_per_degree(middle[:, 0])
    length = np.hypot(way[:, 0] * north, way[:, 1] * east)
    own = sector(*_to_metres(middle[:, 0], middle[:, 1], centre), count)
    total = np.bincount(own, length, count).astype(np.float64)
    sums = np.stack([np.bincount(own, length * middle[:, axis], count) for axis in (0, 1)], axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return total, sums / total[:, None]


def split_line(line: Line, centre: tuple[float, float], count: int) -> list[list[Array]]:
    """Split the outer rings of a line into polylines (n, 2) of each sector, degrees east and north."""
    latitude, longitude, after = line
    parts: list[list[Array]] = [[] for _ in range(count)]
    outer = outer_points(*_to_metres(latitude, longitude, centre), after)
    points = np.column_stack([longitude, latitude])
    middle = 0.5 * (points + points[after])
    own = sector(*_to_metres(middle[:, 1], middle[:, 0], centre), count)
    left = np.zeros(len(after), bool)
    left[outer] = True
    for first in outer.tolist():
        if not left[first]:
            continue
        ring = [first]
        while (there := int(after[ring[-1]])) != first:
            ring.append(there)
        left[ring] = False
        changes = [k for k in range(len(ring)) if own[ring[k]] != own[ring[k - 1]]] or [0]
        for begin, end in zip(changes, [*changes[1:], changes[0] + len(ring)], strict=True):
            part = [ring[k % len(ring)] for k in range(begin, end + 1)]
            parts[own[part[0]]].append(points[part])
    return parts


def outer_points(x: Array, y: Array, after: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the indices of points on counter-clockwise lines: around burned ground, not around islands."""
    ring = np.arange(len(after))
    step = after
    for _ in range(len(after).bit_length()):  # smallest index of each ring, by pointer doubling
        ring = np.minimum(ring, ring[step])
        step = step[step]
    area = np.bincount(ring, x * y[after] - x[after] * y, len(after))
    return np.flatnonzero(area[ring] > 0.0)


def _to_metres(latitude: ArrayLike, longitude: ArrayLike, centre: tuple[float, float]) -> tuple[Array, Array]:
    """Convert points to metres east and north of the centre."""
    north, east = metres_per_degree(centre[0])
    return (np.asarray(longitude) - centre[1]) * east, (np.asarray(latitude) - centre[0]) * north


def _centre(grid: ArrivalGrid, start: float) -> tuple[float, float]:
    """Return the centre of the area burned by the order, or of the cells that burn first."""
    weight = np.where(grid.arrival <= max(start, _first_arrival(grid)), grid.areas, 0.0)
    if weight.sum() == 0.0:
        return 0.5 * float(grid.latitude[0] + grid.latitude[-1]), grid.middle
    weight = weight / weight.sum()
    return float(weight.sum(1) @ grid.latitude), float(weight.sum(0) @ grid.longitude)
