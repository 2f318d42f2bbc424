"""Protocol of a camera's table, for passes and rigs, which the table lists."""

from __future__ import annotations

from typing import Any, Protocol

from ..schema.frame_list import FrameList


class CameraSettings(Protocol):
    """Table of a camera as its passes and its rig see it; `settings.Camera` is one."""

    @property
    def name(self) -> str:
        """Name of the camera."""

    @property
    def frames(self) -> FrameList:
        """Frames that it films."""

    @property
    def passes(self) -> tuple[str, ...]:
        """Passes that it records; empty: the passes of [render]."""

    @property
    def resolution(self) -> tuple[int, int] | None:
        """Width and height (pixels) of its pictures; None: the resolution of [render]."""

    @property
    def kind(self) -> str:
        """Name of its rig."""

    @property
    def rig(self) -> Any:
        """Setup and motion of the camera (see `cameras.rigs.Rig`)."""
