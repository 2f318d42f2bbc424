"""Eye-dome lighting of the visible picture: pixels behind their neighbours are darkened, to show shape.

The FIRETWIN paper uses it without its parameters; strength and radius are chosen by eye.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import DerivedPass, Files

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..shot import Shot

STRENGTH, RADIUS = 4.0, 1


def finish(files: Files, needed: Mapping[str, Files], _shot: Shot, _camera: str, _frame: int) -> None:
    """Darken the picture by eye-dome lighting from depth."""
    from firetwin_core import sensor

    depth = sensor.read_image(needed["depth"]["exr"])[..., 0]
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    sensor.write_image(files["png"], rgb * sensor.eye_dome(depth, STRENGTH, RADIUS)[..., None])


PASS = DerivedPass(
    name="edl",
    order=40,
    help="Visible picture with eye-dome lighting from depth",
    files=("png",),
    film=True,
    needs=("rgb", "depth"),
    finish=finish,
)
