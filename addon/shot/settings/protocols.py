"""Protocols of a shot for cameras, passes and the terrain mesh, which avoid a circular import.

Rigs and passes are choices of the settings, and a shot is made from settings.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    import numpy as np
    from firetwin_core.run import Run
    from numpy.typing import NDArray


class Frames(Protocol):
    """Frames of a shot and their model times, s (see `shot.frames`)."""

    @property
    def first(self) -> float:
        """Model time of the first frame, s."""

    @property
    def last(self) -> float:
        """Model time of the last frame, s."""

    @property
    def count(self) -> int:
        """Number of frames."""

    @property
    def step(self) -> float:
        """Model seconds per frame."""

    @property
    def times(self) -> NDArray[np.float64]:
        """Model times (count,) of all frames, s."""

    def time(self, frame: float) -> float:
        """Model time (s) that a frame shows."""


class CameraSettings(Protocol):
    """A camera's table in a scene file (see `settings.Camera`)."""

    @property
    def name(self) -> str:
        """Name of the camera."""

    @property
    def frames(self) -> str:
        """Frames that it films, such as "1-10"; empty: all."""

    @property
    def passes(self) -> tuple[str, ...]:
        """Passes that it records; empty: those of [render]."""

    @property
    def resolution(self) -> tuple[int, int] | None:
        """Width and height (pixels) of its pictures; None: those of [render]."""

    @property
    def kind(self) -> str:
        """Name of its rig."""

    @property
    def rig(self) -> Any:
        """Setup and motion of the camera (see `cameras.rigs.Rig`)."""


class ShotView(Protocol):
    """Shot as seen by the modules that `shot.Shot` is composed of."""

    @property
    def settings(self) -> Any:
        """The scene file, a `settings.Settings`."""

    @property
    def run(self) -> Run:
        """The model run."""

    @property
    def others(self) -> Mapping[str, Run]:
        """Comparison runs of the scene file, by name."""

    @property
    def frames(self) -> Frames:
        """Frames and their model times."""

    @property
    def cameras(self) -> Sequence[Any]:
        """All cameras of the scene file."""

    @property
    def full(self) -> Any:
        """The full shot of which this is a subset; else itself."""

    @property
    def paths(self) -> list[Any]:
        """Path (`cameras.path.Path`) of each filmed camera."""

    @property
    def perspective_paths(self) -> list[Any]:
        """Paths of the perspective cameras."""

    @property
    def beyond(self) -> bool:
        """Whether a camera sees the Earth beyond the terrain."""

    @property
    def pixel(self) -> tuple[float, float]:
        """Smallest pixel size: m per m of distance in perspective, and m in orthographic views."""

    @property
    def ground(self) -> Any:
        """Terrain (`terrain.terrain.Terrain`) with added detail near the cameras' paths."""

    @property
    def bare_ground(self) -> Any:
        """Terrain without camera-dependent detail."""

    @property
    def front(self) -> Any:
        """Fire front properties (`fire.flame_depth.FrontFields`)."""

    @property
    def visibility(self) -> Any:
        """Visibility queries (`visibility.Visibility`) of the cameras."""

    def resolution(self, camera: Any) -> tuple[int, int]:
        """Width and height (pixels) of a camera's pictures."""

    def filmed(self, path: Any) -> NDArray[np.int64]:
        """Frames, from 0, that a path's camera films."""
