"""Where the fire of a run began: the published place of a known fire, else the run's first cells."""

from __future__ import annotations

from firetwin_core.run import Run

from ..data import history
from . import fire_arrival


def find(run: Run) -> tuple[tuple[float, float], str] | None:
    """Latitude and longitude, degrees, and their source; None where nothing burns."""
    if run.event in history.events():
        point = history.load(run.event).ignitions[0]
        return (point.latitude, point.longitude), point.source
    first = fire_arrival.first_burned(run)
    return None if first is None else (first, "the run's first cells")
