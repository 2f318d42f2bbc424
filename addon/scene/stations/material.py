"""Colours of signs and routes by origin: fact, exercise or user."""

from __future__ import annotations

import bpy

from ...shot.shot import Shot
from ...shot.stations.station_signs import FACT, INVENTED, USER
from ..labels import material

TITLE = "Stations"
ACCENTS = {FACT: (0.95, 0.95, 0.92), INVENTED: (1.0, 0.42, 0.03), USER: (0.25, 0.62, 1.0)}
"""Linear colours in the picture, chosen by eye: white, amber, blue."""


def signs(shot: Shot) -> list[bpy.types.Material]:
    """Build the materials of signs: letters, plate, and an accent for each of `ACCENTS`."""
    plain = [material.build(shot, name, colour, TITLE) for name, colour in material.COLOURS.items()]
    return plain + [material.build(shot, name.title(), colour, TITLE) for name, colour in ACCENTS.items()]


def accent(origin: str) -> int:
    """Return the index of an accent in `signs`."""
    return len(material.COLOURS) + list(ACCENTS).index(origin)


def routes(shot: Shot) -> list[bpy.types.Material]:
    """Build the materials of routes, one for each of `ACCENTS`."""
    return [
        material.build(shot, f"Route {name.title()}", colour, TITLE, "GEOMETRY")
        for name, colour in ACCENTS.items()
    ]
