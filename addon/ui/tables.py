"""Tables of a scene file, such as that of a camera, as text that a property of Blender can keep."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..shot.settings import scene_file, toml_writer
from ..shot.settings.schema import Field


def to_text(part: Field, tables: tuple[Any, ...]) -> str:
    """A list of tables as the lines of a scene file; paths are absolute, nothing is explained."""
    return toml_writer.tables(part.name, tables)


def from_text(part: Field, text: str) -> tuple[Any, ...]:
    """The tables that `to_text` has written, or that were typed in.

    Raises
    ------
    InputError
        Names line and column of what is wrong in the text.
    """
    return getattr(scene_file.parse(text, Path("scene.toml")), part.name)
