"""Single-volume smoke: one volume per frame, lit by Cycles."""

from __future__ import annotations

import functools
from abc import abstractmethod
from pathlib import Path
from typing import Any, ClassVar

from firetwin_core import volume

from ... import files
from ...errors import writing
from .. import cache
from ..view import Resolution, resolution
from ._source import Source, VolumeLayer

SHOWN = ("density", "dilution", "shade", "size", "glow")
"""Grids that the material uses."""


class SingleVolume(Source):
    """Smoke in one volume per frame, at the resolution of the nearest camera.

    Attributes
    ----------
    made_from
        Origin of the smoke, for the file's metadata.
    """

    made_from: ClassVar[str]
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
        """Write the volume of a frame."""
        time = float(self.times[frame - 1])
        more: dict[str, Any] = {
            "grids": None if self.shot.settings.smoke.complete else SHOWN,
            "views": self.view_set(frame),
            "metadata": self.metadata(time, self.made_from),
        }
        position, power = self.lights(time)
        if len(power):
            more |= {"flame_position": position, "flame_power": power}
        mine = files.temporary_path(path)
        with writing(path):
            written = self._write_volume(mine, time, more)
        cache.publish(mine, path, written.bytes)
        return written

    @abstractmethod
    def _write_volume(self, path: Path, time: float, more: dict[str, Any]) -> volume.VdbSummary:
        """Write the smoke at a model time (s). `more` has further arguments of the core's writer."""
