"""What cameras, passes and the terrain's mesh need to know of a shot, so that they need not import it.

Rigs and passes are choices of the settings, and a shot is made of settings; these types break that circle.
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
        """Its name."""

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
        """How it is set up and moved (see `cameras.rigs.Rig`)."""


class ShotView(Protocol):
    """What modules that a `shot.Shot` is made of ask of it."""

    @property
    def settings(self) -> Any:
        """The scene file, a `settings.Settings`."""

    @property
    def run(self) -> Run:
        """The model run."""

    @property
    def others(self) -> Mapping[str, Run]:
        """The scene file's other runs by name."""

    @property
    def frames(self) -> Frames:
        """Frames and their model times."""

    @property
    def cameras(self) -> Sequence[Any]:
        """All cameras of the scene file."""

    @property
    def paths(self) -> list[Any]:
        """`cameras.path.Path` of each camera that is filmed."""

    @property
    def perspective_paths(self) -> list[Any]:
        """Those of the cameras in perspective."""

    @property
    def pixel(self) -> tuple[float, float]:
        """Sizes of the smallest pixels: in perspective m per m of distance, with parallel lines m."""

    @property
    def ground(self) -> Any:
        """The `terrain.terrain.Ground`, with detail along the cameras' paths."""

    @property
    def bare_ground(self) -> Any:
        """The terrain without that detail."""

    @property
    def front(self) -> Any:
        """`fire.flame_depth.Fields` of the front."""

    @property
    def visibility(self) -> Any:
        """`visibility.Visibility` of the cameras."""

    def resolution(self, camera: Any) -> tuple[int, int]:
        """Width and height (pixels) of a camera's pictures."""

    def filmed(self, path: Any) -> NDArray[np.int64]:
        """Frames, from 0, that a path's camera films."""
