"""Time window of a film: the most active part of a run, if possible by daylight; smoke flows at its speed."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime

import numpy as np
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from ..progress import duration
from ..run import areas, burning, extent, sun, times, zone
from ..shot.fire import smoke_scale
from ..shot.sections import Time

FRAMES, FPS = 48, 12  # four seconds, as in the example
# Times real time, least and most, and the fire's size (m) from which the most applies: from frame to frame
# the smoke of a drone's picture then moves by a few pixels (by eye, and by the subject "motion" of the bench)
_SPEED, _LARGE = (1.0, 15.0), 15_000.0
_STEP = 60.0  # s; most time between the starts of candidate windows
NEARLY = 0.7  # of the most fuel that a window by daylight has to reach to be chosen (by eye)
_SUN_STEP = 600.0  # s between solar elevations

Array = NDArray[np.float64]


def choose(run: Run, asked: Time, sun_above: float = 0.0, nearly: float = NEARLY) -> tuple[Time, str]:
    """Choose the [time] of a film: as `asked`, or else the most active part; also a description.

    Parameters
    ----------
    sun_above
        Elevation of the sun (degrees) above which there is daylight.
    nearly
        Part of the most fuel that a window by daylight has to reach to be chosen.
    """
    first, last = float(run.times[0]), float(run.times[-1])
    there = zone.time_zone(run)
    whole = Time(frames=FRAMES, fps=FPS, zone=there)
    if asked.start or asked.end:
        chosen = replace(asked, zone=there)
        start, end = asked.start or times.utc(run, first), asked.end or times.utc(run, last)
        pace = _pace((end - start).total_seconds(), asked.frames, float(asked.rate))
        return chosen, f"{_words(start, end, there)}, as asked; {pace}"
    if last <= first:
        return replace(whole, frames=1), "the one moment of the run"
    arrival = run.fuel_arrival_time()
    row, column, fuel = _burned(run, arrival)
    if len(row) == 0:
        return whole, "all of the run, in which nothing burns"
    came, whole_run = arrival[row, column], last - first
    seconds = length(_size(run, arrival <= last), whole_run)
    seconds = max(seconds, min(_unresolved(run, arrival, row, column), whole_run))
    begins, reached = activity(came, fuel, first, last, seconds)
    most, day = best(reached), _best_by_day(run, begins + 0.5 * seconds, reached, sun_above)
    filmed = day if day is not None and reached[day] >= nearly * reached[most] else most
    start, end = (times.utc(run, begins[filmed] + more) for more in (0.0, seconds))
    part = f"{100.0 * reached[filmed] / fuel.sum():.2g} % of the fuel that burns in the run"
    light = "" if most == day else _light(run, begins, reached, filmed, most, day)
    words = (
        f"{_words(start, end, there)}, the most active {duration(seconds)}"
        f"{' by daylight' * (filmed != most)}: {part}; {_pace(seconds)}{light}"
    )
    return replace(whole, start=start, end=end), words


def length(size: float, whole: float) -> float:
    """Length of the window (s) for a fire of `size` m in a run of `whole` s.

    Speed scales as the times of eddies, with the power 2/3 of the size (see `smoke_scale`).
    """
    speed = float(np.clip(_SPEED[1] * (size / _LARGE) ** (2.0 / 3.0), *_SPEED))
    return min(speed * (FRAMES - 1) / FPS, whole)


def activity(
    arrival: ArrayLike, fuel: ArrayLike, first: float, last: float, length: float
) -> tuple[Array, Array]:
    """Compute the fuel (n,) that the front reaches in windows of `length` s, by their starts (n,), s.

    Windows within the run begin every minute after `first`, or every `length` in whole seconds if that is
    shorter; one more is the last.

    Parameters
    ----------
    arrival, fuel
        (n,) arrival times, s, and fuel in any unit.
    first, last
        Model times of the run's start and end, s.
    """
    arrival, fuel = np.asarray(arrival, np.float64), np.asarray(fuel, np.float64)
    order = np.argsort(arrival)
    total = np.concatenate([[0.0], np.cumsum(fuel[order])])
    step = min(_STEP, max(np.floor(length), 1.0))
    begin = np.append(np.arange(first, last - length, step), max(np.floor(last - length), first))
    before = np.searchsorted(arrival[order], begin, "left")
    by = np.searchsorted(arrival[order], begin + length, "right")
    return begin, total[by] - total[before]


def best(reached: Array) -> int:
    """Return the index of the most active window; of equal ones the last, with flames from its beginning."""
    return int(np.flatnonzero(reached == reached.max())[-1])


def _best_by_day(run: Run, middle: Array, reached: Array, above: float) -> int | None:
    """Return the index of the most active window (n,) by daylight in its middle (s); None without one."""
    sampled = np.append(np.arange(middle[0], middle[-1], _SUN_STEP), middle[-1])
    height = [sun.position(run, float(time))[1] for time in sampled]
    by_day = np.flatnonzero(np.interp(middle, sampled, height) > above)
    if not len(by_day) or not reached[by_day].any():
        return None
    return int(by_day[best(reached[by_day])])


def _light(run: Run, begins: Array, reached: Array, chosen: int, most: int, day: int | None) -> str:
    """Describe the most active window in other light than the chosen one's."""
    if day is None:
        return "; by night, and nothing burns by daylight"
    other = most if chosen == day else day
    when, share = times.iso(times.utc(run, begins[other])), reached[other] / reached[chosen]
    if chosen == day:
        return f"; by night, {when} has {share:.2g} times the fuel"
    return f"; by night: daylight with the most fire ({100.0 * share:.0f} %) begins at {when} (--start)"


def _burned(run: Run, arrival: Array) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    """Row and column of the fuel cells that burn during the run, and their fuel, kg/m2.

    In a run without fuel data all cells have equal weight.
    """
    first, last = float(run.times[0]), float(run.times[-1])
    with np.errstate(invalid="ignore"):
        row, column = np.nonzero((arrival >= first) & (arrival <= last))
    surface, canopy = (
        np.nan_to_num(field[row, column].astype(np.float64)) for field in (run.surface_fuel, run.canopy_fuel)
    )
    fuel = surface + canopy
    return row, column, fuel if np.any(fuel > 0.0) else np.ones(len(row))


def _unresolved(run: Run, arrival: Array, row: NDArray[np.int64], column: NDArray[np.int64]) -> float:
    """Median time (s), up to an hour, in which the front crosses a fuel cell too wide for plumes; else 0.

    The smoke of such cells is a layer that hardly changes in a minute: the film shows the fire's spread.
    """
    if smoke_scale.resolves_plume(max(burning.fuel_cell(run))):
        return 0.0
    return float(np.median(burning.crossing(arrival, row, column)))


def _size(run: Run, burned: NDArray[np.bool_]) -> float:
    """Diagonal of the largest fire of a run, m."""
    within = run.latitude, run.longitude
    width, height = areas.cell_size(run.fuel_latitude, run.fuel_longitude, None, within)
    return extent.largest(burned, (height, width))


def _words(start: datetime, end: datetime, zone: str) -> str:
    """Format a time span: ``12 Aug 2022 14:00:00 to 14:00:59 -07``; with two dates if they differ."""
    first, last = (times.text(moment, zone, seconds=True).split(" ") for moment in (start, end))
    return f"{' '.join(first[:4])} to {' '.join(last[3:] if first[:3] == last[:3] else last)}"


def _pace(seconds: float, frames: int = FRAMES, fps: float = FPS) -> str:
    """Format the speed of a film of a window: ``48 frames, 15 times real time``."""
    speed = float(f"{seconds * fps / max(frames - 1, 1):.3g}")
    return f"{frames} frames, {speed:,g} times real time"
