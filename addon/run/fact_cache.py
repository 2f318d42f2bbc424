"""Fact cache: derived properties of a run, stored in its folder."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import firetwin_core
from firetwin_core.run import Run

from .. import files
from ..data import history
from ..errors import InputError
from . import content

NAME = ".firetwin-info.json"


def facts(run: Run, about: str, find: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    """Return the result of `find` (JSON data), cached while the run's files and the program are unchanged.

    Nothing is stored if the folder is read-only or files may still change.
    """
    place = Path(run.path) / NAME
    stamps = content.stamps(run)
    key = content.fingerprint({"about": about, "run": stamps, "program": _program()})
    with contextlib.suppress(OSError, ValueError, KeyError, TypeError):
        known = files.read_json(place)
        if known["key"] == key:
            return dict(known["facts"])
    result = find()
    if content.settled(stamps.values()) and content.stamps(run) == stamps:
        text = json.dumps({"key": key, "facts": result})
        with contextlib.suppress(OSError, InputError):
            files.write_text(place, text)
    return result


def _program() -> dict[str, content.Stamp]:
    """Return change stamps of the program files that compute the facts."""
    events, code = Path(history.__file__), Path(__file__).parent.glob("*.py")
    parts = [Path(firetwin_core.__file__), events, *events.parent.glob("*.toml"), *code]
    return {path.name: content.stamp(path) for path in sorted(parts)}
