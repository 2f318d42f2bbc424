"""Story file (story.toml): a storyboard, which people edit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import Any
from zoneinfo import ZoneInfo

from .. import output
from ..errors import input_error, reading
from ..files import read_text, relative
from ..limits import SETTINGS_BYTES
from ..shot.schema import Field, fields, validate
from ..shot.settings import toml_writer
from ..shot.settings.scene_file import TableReader
from ..toml_text import loads
from .storyboard import Storyboard
from .words import Words, rounded

NAME = "story.toml"

_HEAD = """\
# Storyboard of a film: `firetwin story` renders it again after each change; pictures that match stay.
# Change the order of the [[shots]], their times, lengths (seconds), captions and cameras, or delete shots.
# picture = "card" shows the caption alone, "map" the growth on a map, and "scene" the view of a camera.
# Cameras: globe, flight, front, ground, above, goes, overview, chase, flank, satellite, or of the scene file.
# Camera positions are in shots/NAME.toml; delete that file to fit them to changed times.
# To translate the film, change the captions and [words]."""


def read(path: Path) -> Storyboard:
    """Read and validate a story file; relative paths start at its folder.

    Raises
    ------
    InputError
        The error names the file, line and column, and the remedy.
    """
    with reading(path):
        text = read_text(path, "utf-8-sig", most=SETTINGS_BYTES)
    data = loads(path, text)
    reader = TableReader(path, text, "story file")
    story: Storyboard = replace(reader.table(Storyboard, data, ()), path=path)
    if invalid := validate(story):
        raise reader.error(*invalid)
    if not story.run.exists():
        raise input_error(path, f"run: there is no {story.run}; check the path")
    return story


def text(story: Storyboard) -> str:
    """Write a storyboard as the content of its file."""
    blocks = [_HEAD, *(_described(story, each) for each in (story, story.words))]
    for name, tables in (("shots", story.shots), ("omitted", story.omitted)):
        blocks += ["\n".join([f"[[{name}]]", *(line for _, line in _lines(story, each))]) for each in tables]
    return "\n\n".join(blocks) + "\n"


def _described(story: Storyboard, table: Storyboard | Words) -> str:
    """Write all keys of a table, each with its description."""
    head = [] if table is story else ["[words]"]
    lines = (f"{line:<34}  # {part.key.described()}" for part, line in _lines(story, table, always=True))
    return "\n".join([*head, *lines])


def write(story: Storyboard, overwrite: bool = False) -> None:
    """Write a storyboard to its file; with `overwrite` also over a file that people changed.

    Raises
    ------
    InputError
        A value is invalid, or the file may not be replaced.
    """
    if invalid := validate(story):
        raise input_error(story.path, invalid[1])
    output.write_text(story.path, text(story), overwrite)


def _lines(story: Storyboard, table: Any, always: bool = False) -> Iterator[tuple[Field, str]]:
    """Write keys of a table: all of them with `always`, else those that differ from their defaults."""
    for part in fields(table.__class__):
        value = getattr(table, part.name)
        if part.table or value is None or (value == part.default and not always):
            continue
        speed = table.speed if part.name == "seconds" else 0.0
        remark = f"  # {rounded(speed)} times real time" if speed else ""
        yield part, f"{part.name} = {_value(story, value)}{remark}"


def _value(story: Storyboard, value: Any) -> str:
    """Write a value in TOML; times are in the story's zone, paths relative to its file."""
    if isinstance(value, datetime):
        return value.astimezone(ZoneInfo(story.zone or "UTC")).isoformat(timespec="milliseconds")
    if isinstance(value, Path):
        return toml_writer.quoted(relative(value, story.path.parent).as_posix())
    if isinstance(value, str):
        return toml_writer.quoted(value)
    return repr(value).lower()
