"""Fire fronts of a run by time: simplified closed lines, and the burned area at each time."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from zoneinfo import ZoneInfo

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..ellipsoid import metres_per_degree
from . import areas, info, times
from .front import Reach, reach

MOST = 48
"""Maximum number of times between the first and the last."""
_STEPS = (60, 120, 300, 600, 900, 1800, 3600, 7200, 10800, 21600, 43200, 86400)  # s
_TOLERANCE = 0.5  # maximum deviation of a line, in fuel cells
_MOST_POINTS = 150_000  # all fronts, about 3 MB; above it the tolerance is doubled

Line = NDArray[np.float64]


@dataclass(frozen=True)
class Front:
    """Front at a model time (s): UTC, closed lines of degrees east and north (n, 2), and burned area, m2."""

    time: float
    utc: datetime
    lines: list[Line]
    area: float


def find(run: Run, zone: str) -> tuple[list[Front], float]:
    """Trace the fronts of a run at round local times, and at its first and last time (see `at_times`)."""
    return at_times(run, choose_times(run, zone))


def at_times(run: Run, moments: list[float]) -> tuple[list[Front], float]:
    """Trace the fronts of a run at model times (s).

    Returns
    -------
    list of Front
        Simplified lines with at most `_MOST_POINTS` points in total.
    float
        Maximum deviation of the lines, m: half a fuel cell, or more for long fronts.
    """
    fire = reach(run)
    whole = [trace(fire, time) for time in moments]
    tolerance = cell_tolerance(fire)
    lines = _simplified(whole, fire, tolerance)
    while sum(len(line) for front in lines for line in front) > _MOST_POINTS and any(map(_is_long, whole)):
        tolerance *= 2.0
        lines = _simplified(whole, fire, tolerance)
    found = zip(moments, lines, info.burned(run, moments), strict=True)
    return [Front(time, times.utc(run, time), front, area) for time, front, area in found], tolerance


def cell_tolerance(fire: Reach) -> float:
    """Return half of the fuel cell size, m."""
    return _TOLERANCE * min(areas.cell_size(fire.latitude, fire.longitude))


def choose_times(run: Run, zone: str) -> list[float]:
    """Choose ascending model times (s): round local times between the first and the last time of the run."""
    first, last = float(run.times[0]), float(run.times[-1])
    span = last - first
    step = next((step for step in _STEPS if span / step <= MOST), 86400 * int(np.ceil(span / 86400 / MOST)))
    start = times.utc(run, first)
    offset = start.astimezone(ZoneInfo(zone)).utcoffset()
    clock = start.timestamp() + (offset.total_seconds() if offset else 0.0)
    steps = np.arange(first + step - clock % step, last, step)
    inner = [float(time) for time in steps if min(time - first, last - time) > 0.25 * step]
    return [first, *inner, *([last] if last > first else [])]


def trace(fire: Reach, time: float) -> list[Line]:
    """Trace closed lines of the front at a model time (s); the first point is repeated at the end."""
    return rings(*fire.line(time))


def rings(latitude: Line, longitude: Line, after: NDArray[np.int64]) -> list[Line]:
    """Collect closed lines from points (n,) and the index of the next point of each (see `front.contour`)."""
    lines, left = [], np.ones(len(after), bool)
    for start in range(len(after)):
        if not left[start]:
            continue
        ring, at = [], start
        while left[at]:
            left[at] = False
            ring.append(at)
            at = int(after[at])
        lines.append(np.column_stack([longitude[[*ring, start]], latitude[[*ring, start]]]))
    return lines


def _simplified(fronts: list[list[Line]], fire: Reach, tolerance: float) -> list[list[Line]]:
    """Simplify all lines; if the tolerance exceeds the cell tolerance, smaller islands are removed."""
    scale = tolerances_per_degree(fire, tolerance)
    least = 0.0 if tolerance <= cell_tolerance(fire) else 2.0
    return [
        [simplify(line, scale) for line in lines if np.ptp(line * scale, 0).max() >= least]
        for lines in fronts
    ]


def _is_long(lines: list[Line]) -> bool:
    """Check whether a front has enough points for further simplification."""
    return any(len(line) > 9 for line in lines)


def tolerances_per_degree(fire: Reach, tolerance: float) -> NDArray[np.float64]:
    """Compute the number of tolerances (m) per degree east and north."""
    north, east = metres_per_degree(float(fire.latitude.mean()))
    return np.array([east, north]) / tolerance


def simplify(points: Line, scale: NDArray[np.float64]) -> Line:
    """Simplify a closed line as `simplify_open`; lines that would have no area left stay."""
    found = simplify_open(points, scale)
    return found if len(found) > 3 else points


def simplify_open(points: Line, scale: NDArray[np.float64]) -> Line:
    """Simplify a line; removed points are less than 1 from it after multiplication by `scale`.

    Douglas and Peucker, The Canadian Cartographer 10(2) (1973), starting from the first point and the point
    farthest from it.
    """
    xy = (points - points[0]) * scale
    half = int(np.argmax(np.hypot(*xy.T)))
    kept, parts = {0, half, len(xy) - 1}, [(0, half), (half, len(xy) - 1)]
    while parts:
        first, last = parts.pop()
        if last - first < 2:
            continue
        along = xy[last] - xy[first]
        offset = xy[first + 1 : last] - xy[first]
        length = float(along @ along)
        share = np.clip(offset @ along / length, 0.0, 1.0) if length else np.zeros(len(offset))
        away = np.hypot(*(offset - share[:, None] * along).T)
        farthest = int(np.argmax(away))
        if away[farthest] >= 1.0:
            middle = first + 1 + farthest
            kept.add(middle)
            parts += [(first, middle), (middle, last)]
    return points[sorted(kept)]
