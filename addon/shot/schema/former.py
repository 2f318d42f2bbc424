"""Former names of sections and keys, which are read from scene files and .blend files of the last version."""

from __future__ import annotations

from .toml_positions import Where

FORMER = {"ground": "terrain", "places": "labels"}
"""Sections: former name to present name."""
FORMER_KEYS = {
    ("render", "skip"): "cull",
    ("terrain", "stand"): "height_source",
    ("tiles", "error"): "max_screen_space_error",
    ("tiles", "trees"): "vegetation",
}
"""Keys: present section and former key to present key."""
FORMER_VALUES = {
    ("tiles", "vegetation"): {"ours": "scene", "theirs": "tileset", "ours where it burns": "scene_near_burn"},
}
"""Choices: present section and key to present value by former value."""


def current(where: Where) -> Where:
    """Translate the path of a value to the present names of its section and key."""
    if not where:
        return where
    section, *inner = FORMER.get(str(where[0]), where[0]), *where[1:]
    if not inner:
        return (section,)
    return (section, FORMER_KEYS.get((str(section), str(inner[0])), inner[0]), *inner[1:])
