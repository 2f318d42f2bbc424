"""Camera rigs: each module of this folder is a kind of camera, unless its name begins with "_".

A module defines `RIG`, a frozen dataclass derived from `Rig`. Its fields are keys (see `schema.key`) of the
camera's table. The module's name is the name of the kind; the first line of the class's docstring is its
description.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from .... import plugins

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from firetwin_core.run import Run

    from ...frames import Frames
    from ...schema import Where
    from ...sections.camera import CameraSettings
    from ._view import View

    Place = tuple[Where, float, float]

USUAL = "drone"  # default kind


@dataclass(frozen=True)
class Filming:
    """Run, frames and cameras for which paths are computed.

    Attributes
    ----------
    size
        Width and height of pictures, pixels, of cameras that do not set them.
    seed
        Random seed of vibration.
    """

    run: Run
    frames: Frames
    cameras: Sequence[CameraSettings]
    size: tuple[int, int]
    seed: int

    def resolution(self, camera: CameraSettings) -> tuple[int, int]:
        """Picture width and height of a camera, pixels."""
        return camera.resolution or self.size


class Rig:
    """Camera rig: setup and motion of one kind of camera.

    Attributes
    ----------
    around
        True for a stereo panorama, which only Cycles renders, with square pictures.
    beyond
        True if it sees the Earth beyond the terrain, which is built then.
    """

    around: ClassVar[bool] = False
    beyond: ClassVar[bool] = False

    @classmethod
    def from_view(cls, view: View) -> Rig:
        """Rig that shows about the same as a view; the default kind if this kind cannot."""
        return cls()

    def validate(self) -> tuple[Where, str] | None:
        """Check keys against each other: place in its table, and message after the camera's name; or None."""
        return None

    def coordinates(self) -> list[Place]:
        """Coordinates in its table: place and latitude, longitude; all must lie on the terrain."""
        return []

    def coordinates_in(self, run: Run) -> list[Place]:
        """Coordinates that its table names and only the run knows, as of `coordinates`."""
        return []

    def input_files(self) -> list[Path]:
        """Files that its path depends on."""
        return []

    def followed(self, cameras: Sequence[CameraSettings]) -> CameraSettings | None:
        """Camera among `cameras` on whose path its own depends; None without one."""
        return None

    def validate_against(self, run: Run, frames: Frames) -> tuple[Where, str] | None:
        """Check it against the run: place in its table, and message after the camera's name; or None."""
        return None

    def follows_fire(self) -> bool:
        """Return whether its path depends on where the fire will be."""
        return False

    def path(self, camera: CameraSettings, filming: Filming, ground: Any) -> Any:
        """Path of the camera through the shot (`path.Path`) over this `terrain.Terrain`."""
        raise NotImplementedError


@functools.cache
def kinds() -> dict[str, type[Rig]]:
    """All kinds of camera by name."""
    return plugins.values(__name__, "RIG")
