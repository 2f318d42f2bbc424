"""Picture of the whole Earth, the user's or the default: checks, and its hash for finished pictures."""

from __future__ import annotations

from pathlib import Path

from ...errors import reading
from ...progress import Progress, silent
from ...run import content
from ..schema import scene_text
from ..settings import Settings

_KINDS = (b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n", b"II*\0", b"MM\0*", b"v/1\x01")
_WHERE = "terrain", "globe"
DEFAULT = Path(__file__).with_name("earth.jpg")
"""NASA's Blue Marble without its sea floor, drawn by ``data/earth.py``."""


def check(settings: Settings) -> None:
    """Check that the picture is one, and that it has a credit.

    Raises
    ------
    InputError
        Names the line of the scene file.
    """
    path = settings.terrain.globe
    if path is None:
        return
    if not path.is_file():
        reason = f"terrain.globe: {path} is not a file; name a JPEG, PNG, TIFF or EXR"
        raise scene_text.error_at(settings.path, _WHERE, reason)
    with reading(path), path.open("rb") as file:
        begin = file.read(8)
    if not begin.startswith(_KINDS):
        reason = f"terrain.globe: {path} is not a JPEG, PNG, TIFF or EXR by its first bytes"
        raise scene_text.error_at(settings.path, _WHERE, reason)
    if not settings.terrain.globe_credit.strip():
        reason = "terrain.globe needs terrain.globe_credit, the words that its owner asks for"
        raise scene_text.error_at(settings.path, _WHERE, reason)


def inputs(settings: Settings, progress: Progress = silent) -> dict[str, str]:
    """SHA-256 of the picture, if the settings name one or a camera sees the default."""
    path = settings.terrain.globe
    if path is None and not any(camera.rig.beyond for camera in settings.cameras):
        return {}
    return {"globe": content.of_file(path or DEFAULT, settings.cache, progress)}
