"""Pass of one band of a satellite imager (see `_imager`, which needs NumPy)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import DerivedPass, Files

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..shot import Shot


def band(name: str, order: int, help: str, long: bool) -> DerivedPass:
    """Pass of the long-wave or the short-wave band."""

    def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
        """Draw the band."""
        from . import _imager

        _imager.draw(files["png"], needed["depth"]["exr"], shot, camera, frame, long)

    return DerivedPass(
        name=name,
        order=order,
        help=help,
        files=("png",),
        film=True,
        aspects=frozenset({"time", "camera"}),
        needs=("depth",),
        code=("shot/satellites",),
        finish=finish,
    )
