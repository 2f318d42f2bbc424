"""Forecast of a shot (`[forecast]`): the ensemble, and the member that the run shows."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..errors import InputError
from ..geometry.grids import dilate
from ..progress import Progress, silent
from ..run import areas, content, front, times
from ..run.ensemble import choice, ensemble
from ..run.ensemble.ensemble import Ensemble
from . import frames
from .schema import scene_text
from .schema.did_you_mean import suggestion
from .settings import Settings

AGREES = 0.97
"""Agreement of the burned areas of a run and of a member from which on they are the same fire. Runs of the
sample's ensemble have 0.999 or more with their members, and at most 0.94 with others (measured)."""
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


def files(settings: Settings) -> list[Path]:
    """List the files of the ensemble, if the scene file names one."""
    path = settings.forecast.ensemble
    return _files(path) if path is not None else []


def inputs(settings: Settings, progress: Progress = silent) -> dict[str, str]:
    """SHA-256 of the ensemble's files."""
    return {
        f"forecast {file.name}": content.of_file(file, settings.cache, progress) for file in files(settings)
    }


def member_of(settings: Settings, run: Run, first: bool) -> int:
    """Find the member that a run shows: the setting's for the first run, else the most similar one."""
    found = of(settings)
    return _set_member(settings, found) if first else _most_similar(found, run)[0]


def others(found: Ensemble, shown: int, lines: int) -> list[int]:
    """Choose the other members whose fronts are drawn: nearly the same for each shown member."""
    if not lines:
        return []
    return [member for member in _representatives(found, lines + 1) if member != shown][:lines]


def roles(found: Ensemble, member: int) -> list[str]:
    """List the roles of a member: typical, smallest, largest, outlier."""
    chosen = _chosen(found)
    return [role for role in ("typical", "smallest", "largest", "outlier") if getattr(chosen, role) == member]


def outlier(found: Ensemble) -> int:
    """Return the least deep member."""
    return _chosen(found).outlier


def check(settings: Settings, run: Run) -> None:
    """Check the ensemble, and that the run is its member, over the times of the shot.

    Raises
    ------
    InputError
        Names the line of the scene file and what to do.
    """
    if settings.forecast.ensemble is None:
        return
    try:
        found = of(settings)
    except InputError as error:
        raise _error(settings, "ensemble", f"forecast.ensemble: {error}") from None
    kind = found.manifest.kind
    if settings.forecast.shares and kind != "forecast":
        reason = f"shares of members of the kind {kind} are not a probability; set forecast.shares = false"
        raise _error(settings, "shares", f"forecast.shares: {reason}")
    member = _set_member(settings, found)
    name = found.members[member].name
    same = agreement(found, member, run)
    if same.share < AGREES:
        best, other = _most_similar(found, run)
        hint = f"; it agrees with member {found.members[best].name}" if other.share >= AGREES else ""
        reason = (
            f"the run does not show member {name} of the forecast: of the area that either burned by "
            f"{times.iso(found.valid(same.time))}, {same.share:.0%} burned in both, and {AGREES:.0%} are "
            f"needed{hint}; give the member's run, or the run's member as forecast.member"
        )
        raise _error(settings, "member", reason)
    _check_window(settings, run, found, member)


def check_others(settings: Settings, runs: Mapping[str, Run]) -> None:
    """Check that each comparison run is a member, too.

    Raises
    ------
    InputError
        Names the line of the run that is not.
    """
    if settings.forecast.ensemble is None:
        return
    found = of(settings)
    for i, (name, run) in enumerate(runs.items()):
        best, same = _most_similar(found, run)
        if same.share < AGREES:
            reason = (
                f'run "{name}" is not a member of forecast.ensemble: the most similar, '
                f"{found.members[best].name}, has {same.share:.0%} of the area burned by either in common, "
                f"and {AGREES:.0%} are needed; name the run of a member, or leave out [forecast]"
            )
            raise scene_text.error_at(settings.path, ("runs", i, "path"), reason)


def agreement(found: Ensemble, member: int, run: Run) -> Agreement:
    """Compare burned areas at the last time that run, member and forecast have in common."""
    shift = times.seconds(run, found.issued)
    end = min(found.members[member].end, found.horizon, float(run.times[-1]) - shift)
    theirs = found.arrival(member)
    mine = _burned(found, run, end + shift)
    known = np.isfinite(mine) & ~np.isnan(theirs)
    here, there, area = known & (mine == 1.0), known & (theirs <= end), found.areas
    either = float(area[here | there].sum())
    apart = (here & ~dilate(there, 1, False)) | (there & ~dilate(here, 1, False))
    return Agreement(1.0 - float(area[apart].sum()) / either if either else 1.0, end)


def _burned(found: Ensemble, run: Run, time: float) -> NDArray[np.float64]:
    """Find the state of the ensemble's cells (ny, nx) in a run: 1 burned, 0 not, NaN outside of the run."""
    middle = 0.5 * float(run.longitude[0] + run.longitude[-1])
    latitude, longitude = np.meshgrid(found.latitude, areas.turned(found.longitude, middle), indexing="ij")
    return front.reach(run).burned(latitude, longitude, time)


@functools.lru_cache(maxsize=8)
def _most_similar(found: Ensemble, run: Run) -> tuple[int, Agreement]:
    """Find the member that agrees best with a run."""
    every = [agreement(found, member, run) for member in range(len(found.members))]
    best = max(range(len(every)), key=lambda member: every[member].share)
    return best, every[best]


def _set_member(settings: Settings, found: Ensemble) -> int:
    """Look up `forecast.member`, or the typical one.

    Raises
    ------
    InputError
        There is no such member.
    """
    name, names = settings.forecast.member, [member.name for member in found.members]
    if not name:
        return _chosen(found).typical
    if name in names:
        return names.index(name)
    listed = ", ".join(names[:8]) + (", ..." if len(names) > 8 else "")
    reason = f'forecast.member: there is no "{name}"; the forecast has {listed}{suggestion(name, names)}'
    raise _error(settings, "member", reason)


def _check_window(settings: Settings, run: Run, found: Ensemble, member: int) -> None:
    """Check that the shot lies between the issue time and the member's end.

    Raises
    ------
    InputError
        It does not.
    """
    shown = frames.resolve(settings.time, run)
    first, last = times.utc(run, shown.first), times.utc(run, shown.last)
    end = found.valid(min(found.members[member].end, found.horizon))
    if found.issued <= first and last <= end:
        return
    reason = (
        f"member {found.members[member].name} has {times.iso(found.issued)} to {times.iso(end)}, and the "
        f"shot shows {times.iso(first)} to {times.iso(last)}; change time.start and time.end"
    )
    raise _error(settings, "ensemble", reason)


def _error(settings: Settings, key: str, reason: str) -> InputError:
    return scene_text.error_at(settings.path, ("forecast", key), reason)


def _files(path: Path) -> list[Path]:
    names = (ensemble.MANIFEST, ensemble.ARRIVAL, "latitude.npy", "longitude.npy")
    return [path / name for name in names]


def _stamps(path: Path) -> tuple[tuple[int, ...], ...]:
    return tuple(content.stamp(file) for file in _files(path) if file.is_file())


@functools.lru_cache(maxsize=_CACHED)
def _open(path: Path, _stamps: tuple[tuple[int, ...], ...]) -> Ensemble:
    return ensemble.open(path)


@functools.lru_cache(maxsize=_CACHED)
def _chosen(found: Ensemble) -> choice.Choice:
    return choice.choose(found)


@functools.lru_cache(maxsize=8)
def _representatives(found: Ensemble, count: int) -> tuple[int, ...]:
    return tuple(choice.representatives(found, count))
