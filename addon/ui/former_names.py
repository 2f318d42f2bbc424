"""Migration of .blend files and presets with former names of sections or keys.

Choices are stored as numbers, which do not change when their names do.
"""

from __future__ import annotations

import contextlib
import json
import re
from pathlib import Path
from typing import Any

import bpy

from .. import files, progress
from ..blender import compat, owned, stored_json
from ..errors import InputError
from ..limits import SETTINGS_BYTES
from ..shot.schema.former import FORMER, FORMER_KEYS, FORMER_VALUES, REMOVED, current


@bpy.app.handlers.persistent
def migrate(*_: object) -> None:
    """Move settings and collections of renamed sections to their current names, and print which."""
    renamed: list[str] = []
    for former, name in FORMER.items():
        for collection in bpy.data.collections:
            if owned.is_ours(collection, former.title()):
                owned.mark(collection, name.title())
                collection.name = f"Firetwin {name.title()}"
    for scene in bpy.data.scenes:
        stored = _section(compat.stored_properties(scene).get("firetwin"))
        for former, name in FORMER.items():
            if former in stored:
                kept = stored[former].to_dict() if _section(stored[former]) else {}
                for gone in {former, name} & {*stored.keys()}:
                    del stored[gone]
                stored[name] = kept
                renamed.append(f"[{former}] is called [{name}] now")
        for (section, former), name in FORMER_KEYS.items():
            kept = _section(stored.get(section))
            if former in kept:
                kept[name] = kept[former]
                del kept[former]
                renamed.append(f"{section}.{former} is called {section}.{name} now")
            exact = stored_json.table(kept.get("exact"))
            if former in exact:
                kept["exact"] = json.dumps(exact | {name: exact.pop(former)})
        _store_as_float(_section(stored.get("time")), "fps")
    if renamed:
        names = "; ".join(dict.fromkeys(renamed))
        progress.say(f"{names}; save the file, because former names are read in this version only")


def _section(stored: Any) -> Any:
    """Return the stored values of a section; none if a file has another type in its place."""
    return stored if hasattr(stored, "to_dict") else {}


def _store_as_float(kept: Any, name: str) -> None:
    """Keep a whole number whose property is a float now; Blender drops values of another type."""
    if isinstance(kept.get(name), int):
        kept[name] = float(kept[name])


def update_presets() -> None:
    """Replace former names in the user's presets."""
    for folder in bpy.utils.preset_paths("firetwin"):
        for path in Path(folder).glob("*.py"):
            with contextlib.suppress(OSError, UnicodeDecodeError, InputError):  # it stays as it is
                text = files.read_text(path, most=SETTINGS_BYTES)
                if (new := _with_present_names(text)) != text:
                    path.write_text(new, encoding="utf-8", newline="\n")


def _with_present_names(preset: str) -> str:
    """Replace former names in the text of a preset, lines such as ``firetwin.tiles.error = 2.0``.

    Lines of removed keys become empty.
    """

    def line(found: re.Match[str]) -> str:
        section, key = map(str, current((found[1], found[2])))
        if (section, key) in REMOVED:
            return ""
        value = FORMER_VALUES.get((section, key), {}).get(found[3].strip("'\""))
        return f"firetwin.{section}.{key} = {repr(value) if value else found[3]}"

    return re.sub(r"^firetwin\.(\w+)\.(\w+) = (.*)$", line, preset, flags=re.MULTILINE)


def register() -> None:
    """Migrate presets, and each file after it was loaded."""
    update_presets()
    bpy.app.handlers.load_post.append(migrate)


def unregister() -> None:
    """Stop the migration of loaded files."""
    bpy.app.handlers.load_post.remove(migrate)
