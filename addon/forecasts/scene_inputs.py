"""Ensemble of a scene file (`[forecast]`, see `shot.scene_inputs`): its files, checks and sources."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from pathlib import Path

from firetwin_core.run import Run

from ..errors import InputError
from ..run import times
from ..shot import frames
from ..shot.schema import scene_text
from ..shot.settings import Settings
from . import forecast
from .ensemble import describe

ASPECT = "forecast"


def files(settings: Settings) -> list[Path]:
    """List the files of the ensemble, if the scene file names one."""
    path = settings.forecast.ensemble
    return forecast.files_of(path) if path is not None else []


def sources(settings: Settings) -> list[dict[str, str]]:
    """List the sources of the ensemble."""
    return describe.sources(forecast.of(settings)) if settings.forecast.ensemble else []


def sentences(settings: Settings) -> list[str]:
    """Describe the ensemble for the paragraph on methods."""
    return [describe.sentence(forecast.of(settings).manifest)] if settings.forecast.ensemble else []


def window(settings: Settings) -> tuple[datetime, datetime] | None:
    """Return the issue time and the end of the shown member, UTC; None without an ensemble."""
    if settings.forecast.ensemble is None:
        return None
    ensemble = forecast.of(settings)
    member = ensemble.members[forecast.set_member(settings, ensemble)]
    return ensemble.issued, ensemble.valid(min(member.end, ensemble.horizon))


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
        ensemble = forecast.of(settings)
    except InputError as error:
        raise forecast.error(settings, "ensemble", f"forecast.ensemble: {error}") from None
    kind = ensemble.manifest.kind
    if settings.forecast.shares and kind != "forecast":
        reason = f"shares of members of the kind {kind} are not a probability; set forecast.shares = false"
        raise forecast.error(settings, "shares", f"forecast.shares: {reason}")
    member = forecast.set_member(settings, ensemble)
    name = ensemble.members[member].name
    same = forecast.agreement(ensemble, member, run)
    if same.share < forecast.AGREES:
        best, other = forecast.most_similar(ensemble, run)
        hint = (
            f"; it agrees with member {ensemble.members[best].name}" if other.share >= forecast.AGREES else ""
        )
        reason = (
            f"the run does not show member {name} of the forecast: of the area that either burned by "
            f"{times.iso(ensemble.valid(same.time))}, {same.share:.0%} burned in both, and "
            f"{forecast.AGREES:.0%} are needed{hint}; give the member's run, or the run's member as "
            "forecast.member"
        )
        raise forecast.error(settings, "member", reason)
    _check_window(settings, run, ensemble.members[member].name)


def check_others(settings: Settings, runs: Mapping[str, Run]) -> None:
    """Check that each comparison run is a member, too.

    Raises
    ------
    InputError
        Names the line of the run that is not.
    """
    if settings.forecast.ensemble is None:
        return
    ensemble = forecast.of(settings)
    for i, (name, run) in enumerate(runs.items()):
        if why := forecast.mismatch(ensemble, run):
            reason = (
                f'run "{name}" is not a member of forecast.ensemble: {why}; '
                "name the run of a member, or leave out [forecast]"
            )
            raise scene_text.error_at(settings.path, ("runs", i, "path"), reason)


def _check_window(settings: Settings, run: Run, member: str) -> None:
    """Check that the shot lies between the issue time and the member's end.

    Raises
    ------
    InputError
        It does not.
    """
    shown = frames.resolve(settings.time, run)
    first, last = times.utc(run, shown.first), times.utc(run, shown.last)
    allowed = window(settings)
    assert allowed
    if allowed[0] <= first and last <= allowed[1]:
        return
    reason = (
        f"member {member} has {times.iso(allowed[0])} to {times.iso(allowed[1])}, and "
        f"the shot shows {times.iso(first)} to {times.iso(last)}; change time.start and time.end"
    )
    raise forecast.error(settings, "ensemble", reason)
