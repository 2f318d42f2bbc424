"""The time zone in which a run is told."""

from __future__ import annotations

import numpy as np
from firetwin_core.run import Run

from ..data import history


def of(run: Run) -> str:
    """That of the fire that the run depicts; else the nautical zone of its middle: 15 degrees an hour.

    Etc/GMT zones count westward: Etc/GMT+8 is eight hours behind UTC.
    """
    if run.event in history.events():
        return history.load(run.event).zone
    middle = 0.5 * float(run.longitude[0] + run.longitude[-1])
    hours = int(np.round(((middle + 180.0) % 360.0 - 180.0) / 15.0))
    return f"Etc/GMT{-hours:+d}" if hours else "Etc/GMT"
