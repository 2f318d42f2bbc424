"""Draw the long-wave band of a satellite imager."""

from __future__ import annotations

from collections.abc import Mapping

from ...shot.shot import Shot
from . import Files, _imager


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Draw the brightness temperature of the imager's pixels."""
    _imager.draw(files["png"], needed["depth"]["exr"], shot, camera, frame, long=True)
