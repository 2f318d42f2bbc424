"""Puff source: puffs that rise from burning fuel, as a quick preview."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

from firetwin_core import constants, volume

from ...run import burning, sun
from ...shot.fire.fire import Cells
from .. import stability
from ._single import SingleVolume

METHOD = {"help": "quick preview", "history": "max_age", "solved": False}
_BLOCK, _INTERVAL = 400.0, 60.0  # m and s within which burning fuel forms one puff, for a fire of 15 km


class PuffSource(SingleVolume):
    """Puffs from burned fuel, heat and wind."""

    name = "puffs"
    preview_of = "flow"
    made_from = "puffs from burned fuel, heat and wind"

    @functools.cached_property
    def cells(self) -> Cells:
        """Find the burning cells that emit puffs, up to the end of the last frame's interval."""
        first = self.times[0] - self.shot.settings.smoke.max_age - burning.BURN_TIME
        return self.shot.fire.cells(first, self.times[-1] + 600.0)

    def puffs(self, time: float) -> volume.Puffs:
        """Compute the puffs at a model time, s."""
        cells, scale = self.cells, self.shot.scale
        return volume.puffs(
            time,
            cells.arrival,
            cells.fuel,
            cells.position,
            cells.wind,
            cells.area,
            max_age=self.shot.settings.smoke.max_age,
            burn_time=burning.BURN_TIME,
            smoke_fraction=self.shot.fire.smoke.per_heat * constants.HEAT_OF_COMBUSTION,
            stability=stability.at_elevation(sun.position(self.shot.run, time)[1]),
            interval=scale.time(_INTERVAL),
            block=scale.length(_BLOCK),
            merge_radius=scale.length(stability.MERGE),
            seed=self.shot.settings.seed,
            smallest=1.2 * self.resolution.voxel,
        )

    def _write_volume(self, path: Path, time: float, more: dict[str, Any]) -> volume.VdbSummary:
        return volume.write_smoke(path, self.puffs(time), self.resolution.voxel, **more)


SOURCE = PuffSource
