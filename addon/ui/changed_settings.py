"""Change tracking: settings that differ from the last build.

Digests of each section's values are stored in the .blend file at a build, and compared whenever a setting
changes. The panel draws a stored text, so undo restores it as well.
"""

from __future__ import annotations

import hashlib
import json

import bpy

from ..blender import stored_json
from ..shot.schema import Field, fields
from ..shot.settings import Settings
from . import keys

ALONE = ("terrain", "forest", "fire", "smoke", "light", "labels", "stations")
"""Parts that, once built, depend only on their own settings.

The other parts depend on the time window and on the cameras, so they are up to date only if all parts were
built."""

_ELSEWHERE = ("path", "cache")


def compute_digests(panel: bpy.types.PropertyGroup) -> dict[str, str]:
    """Return digests of the panel's values of every section, of the run and of the cameras."""
    values = {
        part.name: _shown_values(panel, part) for part in fields(Settings) if part.name not in _ELSEWHERE
    }
    return {name: hashlib.sha256(repr(value).encode()).hexdigest()[:16] for name, value in values.items()}


def _shown_values(panel: bpy.types.PropertyGroup, part: Field) -> object:
    if part.name == "cameras":
        return [(item.name, item.table) for item in panel.cameras]
    if part.tables or part.name == "run":
        return getattr(panel, part.name)
    if part.table:
        group = getattr(panel, part.name)
        return [_shown_values(group, inner) for inner in fields(part.table)]
    use, value = keys.stored_value(panel, part)
    return use, sorted(value) if isinstance(value, set) else value


def store_digests(panel: bpy.types.PropertyGroup, then: dict[str, str], built: tuple[str, ...]) -> None:
    """Store the digests from the time when a build of these parts began."""
    if set(built) > set(ALONE):
        panel.built = json.dumps(then)
    else:
        kept = stored_json.table(panel.built)
        panel.built = json.dumps(kept | {name: then[name] for name in built if name in ALONE})
    compare(panel)


def clear(panel: bpy.types.PropertyGroup) -> None:
    """Delete the digests, because nothing is built."""
    panel.built = panel.changed = ""


def compare(panel: bpy.types.PropertyGroup) -> None:
    """Store the names of sections that differ from the build."""
    if not panel.built:
        return
    built, now = stored_json.table(panel.built), compute_digests(panel)
    panel.changed = " ".join(name for name, digest in now.items() if built.get(name, digest) != digest)


def update_changes(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Compare settings after one has changed (update callback)."""
    panel = getattr(group.id_data, "firetwin", None)
    if panel is not None:
        compare(panel)
