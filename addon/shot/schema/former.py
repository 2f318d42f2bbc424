"""Former names of sections and keys, which are read from scene files and .blend files of the last version."""

from __future__ import annotations

from typing import NamedTuple

from ...toml_text import Where

FORMER = {"ground": "terrain", "places": "labels"}
"""Sections: former name to present name."""
FORMER_KEYS = {
    ("terrain", "stand"): "height_source",
    ("tiles", "error"): "max_screen_space_error",
    ("tiles", "trees"): "vegetation",
}
"""Keys: present section and former key to present key."""
FORMER_VALUES = {
    ("smoke", "method"): {"puffs": "preview"},
    ("tiles", "vegetation"): {"ours": "scene", "theirs": "tileset", "ours where it burns": "scene_near_burn"},
}
"""Choices: present section and key to present value by former value."""


class Removed(NamedTuple):
    """A removed key: its former default, which is read with a note, and the reason."""

    default: object
    reason: str


_CULLING = Removed(True, "culling changes no picture visibly, and is always on")
REMOVED = {
    ("fire", "emitters"): Removed("front", "flames are always placed along the front"),
    ("fire", "volume_voxel"): Removed(0.5, "voxels of flames are 0.5 m wide"),
    ("render", "cull"): _CULLING,
    ("render", "skip"): _CULLING,
    ("smoke", "complete"): Removed(False, "`firetwin export` always writes complete smoke"),
    ("smoke", "extinction"): Removed(0.0, "the extinction of smoke follows from its mass"),
    ("smoke", "lighting"): Removed("solved", "light in smoke is always computed once per frame"),
    ("smoke", "max_age"): Removed(5400.0, "it was the age of puffs, which are gone"),
}
"""Removed keys by section and key. Values other than the default are an error."""


def current(where: Where) -> Where:
    """Translate the path of a value to the present names of its section and key."""
    if not where:
        return where
    section, *inner = FORMER.get(str(where[0]), where[0]), *where[1:]
    if not inner:
        return (section,)
    return (section, FORMER_KEYS.get((str(section), str(inner[0])), inner[0]), *inner[1:])
