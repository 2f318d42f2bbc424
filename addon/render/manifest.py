"""Manifest ``manifest.json``: the store's contents for people and other programs; written when a render ends.

It lists the size, the SHA-256 and the fingerprint of the settings of every finished file, and the full
settings of every fingerprint.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from .. import files, limits
from ..database import BROKEN
from ..errors import input_error
from ..imaging.credits import Credits

NAME = "manifest.json"
EXPOSURE = "exposure"
"""Key of the stops of exposure in the entry of a picture in visible light."""

_FORMAT = 1
_LONGEST = 100  # characters of a name in a message


def read(out: Path) -> dict[str, Any]:
    """Read the manifest of an output folder; empty if the file does not exist.

    Raises
    ------
    InputError
        The file exists and is not a manifest.
    """
    path = out / NAME
    try:
        content = files.read_json(path)
    except (FileNotFoundError, NotADirectoryError):
        return {"format": _FORMAT, "settings": {}, "files": {}}
    except (OSError, ValueError) as error:
        line, column = getattr(error, "lineno", 0), getattr(error, "colno", 0)
        raise input_error(path, BROKEN.format("a manifest"), line=line, column=column) from None
    tables = isinstance(content, dict) and [content.get("settings"), content.get("files")]
    if not tables or content.get("format") != _FORMAT or not all(isinstance(each, dict) for each in tables):
        raise input_error(path, BROKEN.format("a manifest"))
    for table, checks in (("files", _OF_FILES), ("settings", _OF_SETTINGS)):
        if wrong := _wrong_value(content[table], checks):
            raise input_error(
                path, f"{table}{wrong} is not as Firetwin writes it; render again with --resume"
            )
    return content


def _wrong_value(table: dict[str, Any], checks: Mapping[str, Callable[[Any], bool]]) -> str:
    """Return the keys of the first value of another type or range; empty if all are valid."""
    for name, entry in table.items():
        if not isinstance(entry, dict) or not _is_text(name):
            return f".{name[:_LONGEST]!r}"
        for key in entry.keys() & checks.keys():
            if not checks[key](entry[key]):
                return f".{name[:_LONGEST]!r}.{key}"
    return ""


def _is_text(value: Any) -> bool:
    """Check for a text that may be a path, or stand in a page."""
    try:
        return b"\0" not in value.encode()
    except (AttributeError, UnicodeEncodeError):
        return False


def _is_time(value: Any) -> bool:
    first, last = limits.RUN_YEARS
    try:
        return first - 1 <= datetime.fromisoformat(value).astimezone(UTC).year <= last + 1
    except (TypeError, ValueError, OverflowError):
        return False


def _is_count(value: Any) -> bool:
    return type(value) is int and 0 <= value < 2**53


def _is_stops(value: Any) -> bool:
    return type(value) in (int, float) and abs(value) <= 32.0  # Blender has no more


def _is_texts(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(each, str) for each in value)


def _is_table_of_texts(value: Any) -> bool:
    return isinstance(value, dict) and all(map(_is_text, [*value, *value.values()]))


def _is_credits(value: Any) -> bool:
    return isinstance(value, dict) and all(map(_is_texts, value.values()))


def _is_frames(value: Any) -> bool:
    pairs = isinstance(value, list) and all(isinstance(each, list) and len(each) == 2 for each in value)
    return pairs and all(_is_count(frame) for frame, _ in value)


_OF_FILES: dict[str, Callable[[Any], bool]] = {
    **dict.fromkeys(("camera", "pass", "clock", "settings", "film", "sha256"), _is_text),
    **dict.fromkeys(("credits", "services", "missing_tiles"), _is_texts),
    "time": _is_time,
    EXPOSURE: _is_stops,
    "bytes": _is_count,
    "slate_frames": _is_count,
    "frame": lambda value: value is None or _is_count(value),
}
_OF_SETTINGS: dict[str, Callable[[Any], bool]] = {
    **dict.fromkeys(("camera", "pass", "fps", "film"), _is_text),
    "versions": _is_table_of_texts,
    "run": lambda value: isinstance(value, dict),
    "tiles": lambda value: isinstance(value, dict),
    "credits": _is_credits,
    "frames": _is_frames,
}


def write(
    out: Path, settings: dict[str, Any], entries: dict[str, Any], costs: dict[str, Any] | None = None
) -> None:
    """Write the manifest atomically: readers get either the new or the previous one.

    Parameters
    ----------
    costs
        Mean processor seconds of a frame, by camera and part.
    """
    content = {"format": _FORMAT, "settings": settings, "files": entries}
    if costs:
        content["processor_seconds"] = costs
    files.write_text(out / NAME, json.dumps(content, indent=1) + "\n")


def versions(settings: Iterable[Mapping[str, Any]]) -> list[tuple[str, str]]:
    """List the programs that rendered files, with their versions, from the values of `settings`."""
    names = {"firetwin": "Firetwin", "blender": "Blender"}
    pairs = dict.fromkeys(pair for made in settings for pair in made.get("versions", {}).items())
    return [(names.get(name, name), version) for name, version in pairs]


def read_credits(made_with: dict[str, Any]) -> Credits:
    """Return the credits of a picture from the inputs of its fingerprint."""
    found = made_with.get("credits", {})
    return Credits(tuple(found.get("data", ())), tuple(found.get("logo", ())))


def credit_entry(made_with: dict[str, Any], words: Credits | None = None) -> dict[str, list[str]]:
    """Make a picture's credits and missing tiles for its entry.

    Parameters
    ----------
    words
        Further credits.
    """
    named = read_credits(made_with).merge(words or Credits())
    missing = made_with.get("tiles", {}).get("missing", [])
    found = {"credits": list(named.data), "services": list(named.logo), "missing_tiles": missing}
    return {name: values for name, values in found.items() if values}
