"""Model source: smoke of the fire model itself, if the run has it, in one volume per frame, lit by Cycles."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core import volume

from ... import files
from ...errors import writing
from .. import cache
from ..view import Resolution, resolution
from ._source import Source, VolumeLayer

SHOWN = ("density", "dilution", "shade", "size", "glow")
"""Grids that the material uses."""


class ModelSource(Source):
    """Smoke of the model, resampled from terrain-following levels at the resolution of the nearest camera."""

    name = "model"
    fields = ("smoke_3d",)
    unused_settings = ("method", "spin_up", "cell_budget", "cloud_base")

    @functools.cached_property
    def resolution(self) -> Resolution:
        """Smoke resolution."""
        return resolution(self.shot)

    def voxels(self) -> list[Any]:
        """Voxel size, m."""
        return [round(self.resolution.voxel, 3)]

    def layers(self) -> list[VolumeLayer]:
        """Return the single volume layer."""
        return [VolumeLayer("smoke", self.resolution.voxel, self.resolution.step, self.resolution.extinction)]

    def write(self, path: Path, frame: int) -> volume.VdbSummary:
        """Write the volume of a frame; before the first and after the last model time it is empty."""
        run, time = self.shot.run, float(self.times[frame - 1])
        run_time = float(np.clip(time, run.times[0], run.times[-1]))
        smoke = run.smoke_3d_at(run_time)
        if run_time != time:
            smoke[:] = 0.0
        more: dict[str, Any] = {
            "grids": None if self.shot.settings.smoke.complete else SHOWN,
            "views": self.view_set(frame),
            "metadata": self.metadata(time, "of the model, smoke_3d"),
        }
        position, power = self.lights(time)
        if len(power):
            more |= {"flame_position": position, "flame_power": power}
        if run.has("temperature_3d"):
            more["temperature"] = run.temperature_3d_at(run_time)
        mine = files.temporary_path(path)
        with writing(path):
            written = volume.write_levels(
                mine,
                self.shot.local_frame,
                run.air_latitude,
                run.air_longitude,
                self.shot.relief.air,
                run.height_3d_at(run_time),
                smoke,
                self.resolution.voxel,
                **more,
            )
        cache.publish(mine, path, written.bytes)
        return written


SOURCE = ModelSource
