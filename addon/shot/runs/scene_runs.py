"""Runs of a scene file: the first run, and comparison runs."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime

from firetwin_core.run import Run

from ...errors import InputError
from ...run import readers, times
from .. import frames, passes
from ..schema import scene_text
from ..settings import Settings
from ..terrain import elevation


def views(settings: Settings) -> list[str]:
    """Names of all views: cameras in the first run, then in the others (see `passes.view_of`)."""
    names = [camera.name for camera in settings.cameras]
    labels = [run.name for run in settings.runs]
    return names + [passes.view_of(name, label) for label in labels for name in names]


def open_others(settings: Settings) -> dict[str, Run]:
    """Open the comparison runs, by name.

    Raises
    ------
    InputError
        The error names the line of the scene file and the fault of the run.
    """
    runs = {}
    for i, other in enumerate(settings.runs):
        try:
            runs[other.name] = readers.open(other.path)
        except InputError as error:
            if not settings.path.is_file():
                raise
            raise scene_text.error_at(settings.path, ("runs", i, "path"), f"runs.path: {error}") from None
    return runs


def check(settings: Settings, run: Run, others: Mapping[str, Run]) -> None:
    """Check that every run covers the time window of the shot.

    Raises
    ------
    InputError
        The error names the line of the run that does not, and the common time window.
    """
    if not others:
        return
    shown = frames.resolve(settings.time, run)
    first, last = times.utc(run, shown.first), times.utc(run, shown.last)
    spans = {name: _span(other) for name, other in {"": run, **others}.items()}
    low, high = max(span[0] for span in spans.values()), min(span[1] for span in spans.values())
    remedy = (
        f"set time.start and time.end within {times.iso(low)} to {times.iso(high)}, which all runs have"
        if low < high
        else "the runs have no moment in common"
    )
    for i, (name, other) in enumerate(others.items()):
        begin, end = spans[name]
        if not (begin <= first and last <= end):
            reason = (
                f'run "{name}" has {times.iso(begin)} to {times.iso(end)}, and the shot shows '
                f"{times.iso(first)} to {times.iso(last)}; {remedy}"
            )
            raise scene_text.error_at(settings.path, ("runs", i, "path"), reason)
        elevation.check(settings, other)


def _span(run: Run) -> tuple[datetime, datetime]:
    return times.utc(run, float(run.times[0])), times.utc(run, float(run.times[-1]))
