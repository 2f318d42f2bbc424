"""Manifest ``manifest.json``: the store's contents for people and other programs; written when a render ends.

It lists the size, the SHA-256 and the fingerprint of the settings of every finished file, and the full
settings of every fingerprint.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from .. import files
from ..database import BROKEN
from ..errors import input_error, refuse_odd
from ..imaging.credits import Credits

NAME = "manifest.json"
_FORMAT = 1


def read(out: Path) -> dict[str, Any]:
    """Read the manifest of an output folder; empty if the file does not exist.

    Raises
    ------
    InputError
        The file exists and is not a manifest.
    """
    path = out / NAME
    refuse_odd(path)
    try:
        content = files.read_json(path)
    except (FileNotFoundError, NotADirectoryError):
        return {"format": _FORMAT, "settings": {}, "files": {}}
    except (OSError, ValueError) as error:
        line, column = getattr(error, "lineno", 0), getattr(error, "colno", 0)
        raise input_error(path, BROKEN.format("a manifest"), line=line, column=column) from None
    if not isinstance(content, dict) or content.get("format") != _FORMAT:
        raise input_error(path, BROKEN.format("a manifest"))
    return content


def write(out: Path, settings: dict[str, Any], entries: dict[str, Any]) -> None:
    """Write the manifest atomically: readers get either the new or the previous one."""
    text = json.dumps({"format": _FORMAT, "settings": settings, "files": entries}, indent=1) + "\n"
    files.write_text(out / NAME, text)


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
