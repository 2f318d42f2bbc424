"""Tables of a scene file, such as that of a camera, as text that a property of Blender can keep."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..shot import file, toml_text
from ..shot.schema import Part


def to_text(part: Part, tables: tuple[Any, ...]) -> str:
    """A list of tables as the lines of a scene file; paths are absolute, nothing is explained."""
    return toml_text.tables(part.name, tables)


def from_text(part: Part, text: str) -> tuple[Any, ...]:
    """The tables that `to_text` has written, or that were typed in.

    Raises
    ------
    InputError
        Names line and column of what is wrong in the text.
    """
    return getattr(file.parse(text, Path("scene.toml")), part.name)
