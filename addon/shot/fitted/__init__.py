"""Settings that fit a run: its most active part, and cameras that show it.

`firetwin new` writes them as a scene file; `render`, `build` and `bake` of a run folder, and *Open run* in
Blender, take the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from firetwin_core.run import Run

from ...run import times, zone
from ..settings import Settings, Time
from ..shot import Shot
from . import chase, flank, front, overview, satellite, text, window
from .placing import Placed
from .visible import Visible


@dataclass(frozen=True)
class Fitted:
    """Settings that fit a run, and what is said of them.

    Attributes
    ----------
    name
        Of the run.
    window
        A line about the moments that are shown.
    cameras
        A line about each camera, by its name.
    shares
        Of the front that each camera films, how much it shows, 0..1; 0 where nothing burns.
    """

    settings: Settings
    name: str
    window: str
    cameras: dict[str, str]
    shares: dict[str, float]

    @property
    def lines(self) -> list[str]:
        """What was chosen, in a few lines."""
        return [self.window, *(f"{name}: {words}" for name, words in self.cameras.items())]

    @property
    def text(self) -> str:
        """The settings as a short scene file."""
        return text.text(self.settings, self.name, self.window, self.cameras)


def of(run: Run, settings: Settings) -> Fitted:
    """Settings for a run that begin with these, which name the run, the file and the cache."""
    arrival = run.fuel_arrival_time()
    settings, words = _timed(run, arrival, settings)
    settings = replace(
        settings,
        ground=replace(settings.ground, error=0.1),
        render=replace(settings.render, samples=3, passes=("rgb", "thermal")),
    )
    shot = Shot(settings, run)
    moving = front.of(shot)
    placed = _placed(moving)
    whole = replace(settings, cameras=tuple(each.camera for each in placed))
    said, shares = ({each.camera.name: getattr(each, name) for each in placed} for name in ("words", "share"))
    return Fitted(whole, run.name, words, said, shares)


def at(folder: Path, path: Path, cache: Path) -> Fitted:
    """Settings for the run in a folder, as of the scene file `path`.

    Raises
    ------
    InputError
        What is wrong with the run.
    """
    from ...run import readers

    return of(readers.open(folder), Settings(path=path, run=folder, cache=cache))


def _placed(moving: front.Front) -> list[Placed]:
    visible = Visible(moving)
    kinds = (overview, chase, flank, satellite) if len(moving.point) else (overview, satellite)
    return [kind.place(moving, visible) for kind in kinds]


def _timed(run: Run, arrival: np.ndarray, settings: Settings) -> tuple[Settings, str]:
    """The settings with their [time], and what was chosen."""
    first, last = float(run.times[0]), float(run.times[-1])
    row, column, fuel = window.burned(run, arrival)
    there = zone.of(run)
    whole = Time(frames=window.FRAMES, fps=window.FPS, zone=there)
    if last <= first or len(row) == 0:
        frames = window.FRAMES if last > first else 1
        return replace(settings, time=replace(whole, frames=frames)), "all of the run, in which nothing burns"
    length = window.length(_diagonal(run, row, column), last - first)
    begin = window.most_active(arrival[row, column], fuel, first, last, length)
    start, end = (times.moment(run, time) for time in (begin, begin + length))
    inside = (arrival[row, column] >= begin) & (arrival[row, column] <= begin + length)
    part = float(fuel[inside].sum() / fuel.sum())
    day, last_day = (times.text(moment, there).split(" ") for moment in (start, end))
    until = last_day[3:] if day[:3] == last_day[:3] else last_day
    words = (
        f"{' '.join(day[:4])} to {' '.join(until)}, the most active {length / 60.0:.0f} minutes: "
        f"{100.0 * part:.0f} % of the fuel that burns in the run"
    )
    return replace(settings, time=replace(whole, start=start, end=end)), words


def _diagonal(run: Run, row: np.ndarray, column: np.ndarray) -> float:
    """Of what burns in the run, m."""
    from ...run import areas

    latitude, longitude = run.fuel_latitude, run.fuel_longitude
    width, height = areas.cell_size(latitude, longitude, None, (run.latitude, run.longitude))
    return float(np.hypot((np.ptp(row) + 1) * height, (np.ptp(column) + 1) * width))
