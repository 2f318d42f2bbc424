"""What a satellite's imager measures in the middle infrared (3.9 um), labelled (see `_imager`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import Files, Pass

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..shot import Shot


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Draw the band."""
    from . import _imager

    _imager.draw(files["png"], needed["depth"]["exr"], shot, camera, frame, long=False)


PASS = Pass(
    name="imager_short",
    order=50,
    help="What a satellite's imager measures in the middle infrared (3.9 um)",
    files=("png",),
    output="",
    filmed=True,
    shows=frozenset({"time", "camera"}),
    needs=("depth",),
    sources=("shot/passes/_imager.py", "shot/passes/_bar.py", "shot/satellites"),
    finish=finish,
)
