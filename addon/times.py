"""Moments, model times (seconds since the run began) and the frames that show them."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from .project import Project


def run_start(run: Run) -> datetime:
    """Start of the run, UTC."""
    start = datetime.fromisoformat(run.start)
    return start if start.tzinfo else start.replace(tzinfo=UTC)


def seconds(run: Run, moment: datetime) -> float:
    """Model time of a moment; one without a time zone is UTC."""
    moment = moment if moment.tzinfo else moment.replace(tzinfo=UTC)
    return (moment - run_start(run)).total_seconds()


def moment(run: Run, time: float) -> datetime:
    """UTC of a model time (s)."""
    return run_start(run) + timedelta(seconds=time)


def window(project: Project, run: Run) -> tuple[float, float]:
    """Model time (s) of the first and the last frame; a still has one moment, its start."""
    start, end = project.time.start, project.time.end
    first = float(run.times[0]) if start is None else seconds(run, start)
    if project.time.frames == 1:
        return first, first
    last = float(run.times[-1]) if end is None else seconds(run, end)
    return first, last


def step(project: Project, run: Run) -> float:
    """Model seconds per frame."""
    first, last = window(project, run)
    return (last - first) / max(project.time.frames - 1, 1)


def model_time(project: Project, run: Run, frame: float) -> float:
    """Model time (s) that frame 1..frames shows: t_start + (frame - 1) (t_end - t_start) / (frames - 1)."""
    return window(project, run)[0] + (frame - 1.0) * step(project, run)


def frame_times(project: Project, run: Run) -> NDArray[np.float64]:
    """Model times (frames,) in seconds of all frames."""
    return window(project, run)[0] + np.arange(project.time.frames) * step(project, run)


def text(when: datetime, zone: str) -> str:
    """A moment as people write it there: ``17 Sep 2014 15:42 PDT``."""
    local = when.astimezone(ZoneInfo(zone))
    return f"{local.day} {local:%b %Y %H:%M} {local.tzname()}"
