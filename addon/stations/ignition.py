"""Ignition point of a run: the published point of a known fire, otherwise the cells that burn first."""

from __future__ import annotations

from firetwin_core.run import Run

from ..data import history
from . import fire_arrival


def find(run: Run) -> tuple[tuple[float, float], str] | None:
    """Return latitude and longitude, degrees, and their source; None if nothing burns."""
    if run.event in history.events():
        point = history.load(run.event).ignitions[0]
        return (point.latitude, point.longitude), point.source
    first = fire_arrival.first_burned_point(run)
    return None if first is None else (first, "the run's first cells")
