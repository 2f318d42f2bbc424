"""Eye-dome lighting of the visible picture: pixels behind their neighbours are darkened, to show shape.

The FIRETWIN paper uses it without its parameters; strength and radius are chosen by eye.
"""

from __future__ import annotations

from collections.abc import Mapping

from firetwin_core import sensor

from ..shot.passes import DerivedPass, Files
from ..shot.shot import Shot

ORDER = 40
HELP = "Visible picture with eye-dome lighting from depth"

PASS = DerivedPass(files=("png",), film=True, needs=("rgb", "depth"))

STRENGTH, RADIUS = 4.0, 1


def finish(files: Files, needed: Mapping[str, Files], _shot: Shot, _camera: str, _frame: int) -> None:
    """Darken the picture by eye-dome lighting from depth."""
    depth = sensor.read_image(needed["depth"]["exr"])[..., 0]
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    sensor.write_image(files["png"], rgb * sensor.eye_dome(depth, STRENGTH, RADIUS)[..., None])
