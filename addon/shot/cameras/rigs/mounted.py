"""Mounted sensor: further camera on the mount of another, optionally with its own lens."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ...schema import Where, key
from ...schema.bounds import SENSOR as WIDTH
from ..path import SENSOR, Path
from . import Rig
from ._lens import FOCAL_LENGTH, LensRig

if TYPE_CHECKING:
    from ...sections.camera import CameraSettings
    from ...terrain.terrain import Terrain
    from . import Filming


@dataclass(frozen=True)
class Mounted(Rig):
    """Second sensor on another camera's mount, with the same position and direction.

    Without a focal length it has the field of view of that camera; pixels then agree if resolutions do.
    """

    follows: str = key("", "name of the perspective camera that carries it")
    focal_length: float | None = key(
        None, "focal length of a separate lens; default: the lens of that camera", **FOCAL_LENGTH
    )
    sensor_width: float = key(SENSOR, "width of a separate sensor, used with focal_length", **WIDTH)

    def validate(self) -> tuple[Where, str] | None:
        """Check that it has a mount."""
        return None if self.follows else (("follows",), "has no follows; name the camera it is mounted with")

    def followed(self, cameras: Sequence[CameraSettings]) -> CameraSettings | None:
        """Return the perspective camera whose mount it shares; None without a camera of that name."""
        candidates = (camera for camera in cameras if isinstance(camera.rig, LensRig))
        return next((candidate for candidate in candidates if candidate.name == self.follows), None)

    def path(self, camera: CameraSettings, filming: Filming, ground: Terrain) -> Path:
        """Path of the followed camera with its own lens."""
        leader = self.followed(filming.cameras)
        assert leader  # the settings see to it
        way = self.through(leader.rig.path(leader, filming, ground))
        width, height = filming.resolution(camera)
        half = way.half[0], way.half[0] * height / width
        return replace(way, camera=camera, half=half, hidden=None)  # the followed camera warns of ridges

    def through(self, way: Path) -> Path:
        """Path of the mount's camera with this lens; a separate lens has square pictures."""
        if self.focal_length is None:
            return way
        own = 0.5 * self.sensor_width / self.focal_length
        return replace(way, half=(own, own), sensor=self.sensor_width, wider=None)


RIG = Mounted
