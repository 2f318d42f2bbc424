"""Minimap camera: orthographic map that moves with another camera."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...schema import key
from ...schema.bounds import SWATH
from ..path import Path
from . import Rig
from .satellite import down

if TYPE_CHECKING:
    from ...sections.camera import CameraSettings
    from ...terrain.terrain import Terrain
    from . import Filming
    from ._view import View


@dataclass(frozen=True)
class Minimap(Rig):
    """Orthographic camera straight above another camera, with north up."""

    follows: str = key("", "name of the followed camera; empty: the first camera that follows none")
    swath: float = key(6000.0, "swath: ground width of the picture", **SWATH)

    @classmethod
    def from_view(cls, view: View) -> Minimap:
        """Map as wide as the view."""
        return cls(swath=view.width)

    def followed(self, cameras: Sequence[CameraSettings]) -> CameraSettings | None:
        """Return the camera that it follows; None without a camera of that name, or without any."""
        candidates = (camera for camera in cameras if not hasattr(camera.rig, "follows"))
        return next((candidate for candidate in candidates if self.follows in ("", candidate.name)), None)

    def path(self, camera: CameraSettings, filming: Filming, ground: Terrain) -> Path:
        """Path above the followed camera in every frame; above the run's centre without one."""
        leader = self.followed(filming.cameras)
        east, north = np.zeros((2, filming.frames.count))
        if leader is not None:
            way = leader.rig.path(leader, filming, ground)
            east, north = (way.target if way.meet else way.position).T[:2]
        place = np.stack([east, north, ground.up(east, north)], axis=-1)
        return down(camera, filming, place, self.swath)


RIG = Minimap
