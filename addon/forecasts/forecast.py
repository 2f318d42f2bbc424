"""Forecast of a shot (`[forecast]`): the ensemble, and the member that the run shows."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..did_you_mean import suggestion
from ..errors import InputError, input_error
from ..geometry.grids import dilate
from ..run import areas, content, front, times
from ..shot.schema import scene_text
from ..shot.settings import Settings
from .ensemble import choice, ensemble
from .ensemble.ensemble import Ensemble

AGREES = 0.97
"""Agreement of the burned areas of a run and of a member from which on they are the same fire. Runs of the
sample's ensemble have 0.999 or more with their members, and at most 0.94 with others (measured)."""
_SAME = 0.995  # agreement from which on the run is named as the member without its agreement
_CACHED = 2  # ensembles


@dataclass(frozen=True)
class Agreement:
    """Agreement of a run with a member at a time (s since the issue time).

    `share` is the share of the area that either has burned in which the other has burned it, too, or a cell
    next to it: grids of runs are finer.
    """

    share: float
    time: float


def of(settings: Settings) -> Ensemble:
    """Open the ensemble that a scene file names; it is cached until its files change."""
    path = settings.forecast.ensemble
    assert path is not None
    return _open(path, _stamps(path))


def member_of(settings: Settings, run: Run, first: bool) -> int:
    """Find the member that a run shows: the setting's for the first run, else the most similar one."""
    forecast = of(settings)
    return set_member(settings, forecast) if first else most_similar(forecast, run)[0]


def others(forecast: Ensemble, shown: int, lines: int) -> list[int]:
    """Choose the other members whose fronts are drawn: nearly the same for each shown member."""
    if not lines:
        return []
    return [member for member in _representatives(forecast, lines + 1) if member != shown][:lines]


def roles(forecast: Ensemble, member: int) -> list[str]:
    """List the roles of a member: typical, smallest, largest, outlier."""
    chosen = _chosen(forecast)
    return [role for role in ("typical", "smallest", "largest", "outlier") if getattr(chosen, role) == member]


def outlier(forecast: Ensemble) -> int:
    """Return the least deep member."""
    return _chosen(forecast).outlier


def agreement(forecast: Ensemble, member: int, run: Run) -> Agreement:
    """Compare burned areas at the last time that run, member and forecast have in common.

    Two fires without any burned cell by then do not agree.
    """
    shift = times.seconds(run, forecast.issued)
    end = min(forecast.members[member].end, forecast.horizon, float(run.times[-1]) - shift)
    theirs = forecast.arrival(member)
    mine = _burned(forecast, run, end + shift)
    simulated = ~np.isnan(theirs)
    here, there, area = simulated & (mine == 1.0), simulated & (theirs <= end), forecast.areas
    either = float(area[here | there].sum())
    apart = (here & ~dilate(there, 1, False)) | (there & ~dilate(here, 1, False))
    return Agreement(1.0 - float(area[apart].sum()) / either if either else 0.0, end)


def _burned(forecast: Ensemble, run: Run, time: float) -> NDArray[np.float64]:
    """Find the state of the ensemble's cells (ny, nx) in a run: 1 burned, 0 not, NaN outside of the run."""
    middle = 0.5 * float(run.longitude[0] + run.longitude[-1])
    latitude, longitude = np.meshgrid(
        forecast.latitude, areas.turned(forecast.longitude, middle), indexing="ij"
    )
    return front.reach(run).burned(latitude, longitude, time)


@functools.lru_cache(maxsize=8)
def most_similar(forecast: Ensemble, run: Run) -> tuple[int, Agreement]:
    """Find the member that agrees best with a run."""
    every = [agreement(forecast, member, run) for member in range(len(forecast.members))]
    best = max(range(len(every)), key=lambda member: every[member].share)
    return best, every[best]


def mismatch(forecast: Ensemble, run: Run) -> str:
    """Say which member agrees best with a run, if none agrees; else empty."""
    best, same = most_similar(forecast, run)
    if same.share >= AGREES:
        return ""
    return (
        f"the most similar, {forecast.members[best].name}, has {same.share:.0%} of the area burned by either "
        f"in common, and {AGREES:.0%} are needed"
    )


def shown_by(forecast: Ensemble, run: Run) -> str:
    """Name the member that a run shows, in a sentence, with the agreement unless it is complete.

    Raises
    ------
    InputError
        The run is not a member of the forecast: it may be of another fire.
    """
    if reason := mismatch(forecast, run):
        reason = f"has no member that is the run {run.path}: {reason}; give the run of a member"
        raise input_error(forecast.path, reason)
    best, same = most_similar(forecast, run)
    name = forecast.members[best].name
    if same.share >= _SAME:
        return f"The run is member {name} of the forecast."
    return (
        f"The run is similar to member {name} of the forecast, but not equal: of the area that either "
        f"burned by {times.iso(forecast.valid(same.time))}, {same.share:.1%} burned in both."
    )


def set_member(settings: Settings, forecast: Ensemble) -> int:
    """Look up `forecast.member`, or the typical one.

    Raises
    ------
    InputError
        There is no such member.
    """
    name, names = settings.forecast.member, [member.name for member in forecast.members]
    if not name:
        return _chosen(forecast).typical
    if name in names:
        return names.index(name)
    listed = ", ".join(names[:8]) + (", ..." if len(names) > 8 else "")
    reason = f'forecast.member: there is no "{name}"; the forecast has {listed}{suggestion(name, names)}'
    raise error(settings, "member", reason)


def error(settings: Settings, key: str, reason: str) -> InputError:
    """Create an error at a key of [forecast]."""
    return scene_text.error_at(settings.path, ("forecast", key), reason)


def files_of(path: Path) -> list[Path]:
    """List the files of an ensemble."""
    names = (ensemble.MANIFEST, ensemble.ARRIVAL, "latitude.npy", "longitude.npy")
    return [path / name for name in names]


def _stamps(path: Path) -> tuple[tuple[int, ...], ...]:
    return tuple(content.stamp(file) for file in files_of(path) if file.is_file())


@functools.lru_cache(maxsize=_CACHED)
def _open(path: Path, _stamps: tuple[tuple[int, ...], ...]) -> Ensemble:
    return ensemble.open(path)


@functools.lru_cache(maxsize=_CACHED)
def _chosen(forecast: Ensemble) -> choice.Choice:
    return choice.choose(forecast)


@functools.lru_cache(maxsize=8)
def _representatives(forecast: Ensemble, count: int) -> tuple[int, ...]:
    return tuple(choice.representatives(forecast, count))
