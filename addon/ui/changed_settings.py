"""Which settings are no longer those that the scene was built from.

Digests of what the panel shows, one for each section, are kept in the .blend file when something is built
and compared whenever a setting changes: drawing shows a text, and undo takes that back too.
"""

from __future__ import annotations

import hashlib
import json

import bpy

from ..shot.settings.schema import Field, fields
from ..shot.settings.settings import Settings
from . import keys

ALONE = ("terrain", "forest", "fire", "smoke", "light", "labels")
"""Parts whose settings are the scene's once the part is built. What is seen in the world hangs on the moments
and on the cameras, so those are the scene's only when all of it is built."""

_ELSEWHERE = ("path", "cache")


def digests(panel: bpy.types.PropertyGroup) -> dict[str, str]:
    """A digest of what the panel shows of every section, of the run and of the cameras."""
    found = {part.name: _seen(panel, part) for part in fields(Settings) if part.name not in _ELSEWHERE}
    return {name: hashlib.sha256(repr(value).encode()).hexdigest()[:16] for name, value in found.items()}


def _seen(panel: bpy.types.PropertyGroup, part: Field) -> object:
    if part.name == "cameras":
        return [(item.name, item.table) for item in panel.cameras]
    if part.tables or part.name == "run":
        return getattr(panel, part.name)
    if part.table:
        group = getattr(panel, part.name)
        return [_seen(group, inner) for inner in fields(part.table)]
    use, value = keys.stored_value(panel, part)
    return use, sorted(value) if isinstance(value, set) else value


def remember(panel: bpy.types.PropertyGroup, then: dict[str, str], built: tuple[str, ...]) -> None:
    """Keep what `seen` said when these parts began to be built."""
    if set(built) > set(ALONE):
        panel.built = json.dumps(then)
    else:
        kept = json.loads(panel.built or "{}")
        panel.built = json.dumps(kept | {name: then[name] for name in built if name in ALONE})
    compare(panel)


def forget(panel: bpy.types.PropertyGroup) -> None:
    """Nothing is built any more."""
    panel.built = panel.changed = ""


def compare(panel: bpy.types.PropertyGroup) -> None:
    """Write down which sections differ from what was built."""
    if not panel.built:
        return
    built, now = json.loads(panel.built), digests(panel)
    panel.changed = " ".join(name for name, digest in now.items() if built.get(name, digest) != digest)


def note(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """A setting of a panel has changed."""
    panel = getattr(group.id_data, "firetwin", None)
    if panel is not None:
        compare(panel)
