"""Model source: smoke of the fire model itself, if the run has it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core import volume

from ._single import SingleVolume


class ModelSource(SingleVolume):
    """Smoke of the model, resampled from terrain-following levels."""

    name = "model"
    fields = ("smoke_3d",)
    made_from = "of the model, smoke_3d"

    def _write_volume(self, path: Path, time: float, more: dict[str, Any]) -> volume.VdbSummary:
        """Write the smoke at a model time (s); there is none outside of the model's times."""
        run = self.shot.run
        known = float(np.clip(time, run.times[0], run.times[-1]))
        smoke = run.smoke_3d_at(known)
        if known != time:
            smoke[:] = 0.0
        if run.has("temperature_3d"):
            more["temperature"] = run.temperature_3d_at(known)
        return volume.write_levels(
            path,
            self.shot.local_frame,
            run.air_latitude,
            run.air_longitude,
            self.shot.relief.air,
            run.height_3d_at(known),
            smoke,
            self.resolution.voxel,
            **more,
        )


SOURCE = ModelSource
