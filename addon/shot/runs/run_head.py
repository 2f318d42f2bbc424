"""Head of the fire of a run at any time, without a shot: as the head that cameras follow."""

from __future__ import annotations

from datetime import datetime
from functools import cached_property
from pathlib import Path

import numpy as np
from firetwin_core.run import Run

from ...run import times
from ..cameras import targets
from ..settings import Settings
from ..terrain.terrain import Terrain


class Head:
    """Latitude and longitude of the head of a run's fire; called with a time, UTC."""

    def __init__(self, run: Run) -> None:
        self.run = run

    @cached_property
    def _ground(self) -> Terrain:
        return Terrain(Settings(run=Path(self.run.path)), self.run, self.run.fuel_arrival_time())

    def __call__(self, at: datetime) -> tuple[float, float] | None:
        """Degrees north and east; None while nothing burns."""
        time = times.seconds(self.run, at)
        if not (self.run.fuel_arrival_time() <= time).any():
            return None
        latitude, longitude = self._ground.geodetic(*targets.head(self._ground, np.array([time])))
        return float(latitude[0]), float(longitude[0])
