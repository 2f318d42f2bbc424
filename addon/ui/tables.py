"""Tables of a scene file, such as a camera's, as text in a Blender property."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..shot.schema import Field
from ..shot.settings import scene_file, toml_writer


def to_text(part: Field, tables: tuple[Any, ...]) -> str:
    """Serialize a list of tables as lines of a scene file; paths are absolute, without comments."""
    return toml_writer.tables(part.name, tables)


def from_text(part: Field, text: str) -> tuple[Any, ...]:
    """Parse tables from `to_text`, or typed tables.

    Raises
    ------
    InputError
        The text is invalid; with line and column.
    """
    return getattr(scene_file.parse(text, Path("scene.toml")), part.name)
