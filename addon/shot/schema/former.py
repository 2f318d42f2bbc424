"""Former names of sections and keys, which are read from scene files and .blend files of the last version."""

from __future__ import annotations

from .toml_positions import Where

FORMER = {"ground": "terrain", "places": "labels"}
"""Sections: former name to present name."""
FORMER_KEYS = {("render", "skip"): "cull"}
"""Keys: present section and former key to present key."""


def current(where: Where) -> Where:
    """Translate the path of a value to the present names of its section and key."""
    if not where:
        return where
    section, *inner = FORMER.get(str(where[0]), where[0]), *where[1:]
    if not inner:
        return (section,)
    return (section, FORMER_KEYS.get((str(section), str(inner[0])), inner[0]), *inner[1:])
