"""Text form of fitted settings: a short scene file."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

from ..shot.settings import Settings, toml_writer

_WIDTH = 108  # characters of a comment line
_ASKED = (
    "run",
    *(f"time.{name}" for name in ("start", "end", "frames", "fps", "zone")),
    "smoke.method",
    "light.haze",
    *(f"render.{name}" for name in ("resolution", "samples", "passes")),
    *(f"cameras.{name}" for name in ("name", "focal_length", "frames")),
    *(f"cameras.keys.{name}" for name in ("latitude", "longitude")),
)
"""Keys that users often change, written in addition to those that differ from their defaults."""


def text(settings: Settings, name: str, window: str, cameras: Mapping[str, str]) -> str:
    """Format the file, with descriptions above the run and above each camera.

    Parameters
    ----------
    name
        Name of the run.
    window, cameras
        Description of the window, and of each camera by name.
    """
    file = settings.path.name
    head = (
        f"{_wrapped(f'{name}: {window}.')}\n"
        f"`firetwin render {file} --out film` films it, `firetwin build {file} -o scene.blend` builds it for "
        "Blender.\n"
        "Keys that are not here have their defaults; examples/king_fire.toml has and explains them all."
    )
    remarks = {name: _wrapped(f"{words[:1].upper()}{words[1:]}.") for name, words in cameras.items()}
    return toml_writer.brief(settings, _ASKED, {"run": head} | remarks)


def _wrapped(text: str) -> str:
    return "\n".join(textwrap.wrap(text, _WIDTH))
