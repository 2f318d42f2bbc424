"""Labels of place names: text that faces the camera, of equal size in every picture, faded with distance.

A label is a mesh one unit high, of letters, an outline for contrast, and a stem down to the place. It is an
instance on a point there: objects in front of the place occlude it.
"""

from __future__ import annotations

import bpy

from ...blender import owned
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...shot.stations import labels
from . import facing, lettering, material
from .lettering import RIM, Part

# height of the letters over the ground, in letter heights; from row to row
_STEM, _TIER = 2.2, 1.3


def build(shot: Shot, stage: Stage) -> bpy.types.Object | None:
    """Build "Firetwin Labels"; nothing where labels are off or no place is known."""
    collection, settings = stage.part("Labels"), shot.settings.labels
    places = labels.find(shot)
    if not places.names:
        return None
    looks = [material.build(shot, name, colour) for name, colour in material.COLOURS.items()]
    library = owned.library("Place Names")
    rows = facing.tiers(shot, places.position)
    with lettering.typeface() as font:
        for k, (name, row) in enumerate(zip(places.names, rows, strict=True)):
            parts = _label(name, _STEM + _TIER * int(row), font)
            mesh = lettering.mesh(f"Firetwin Place {k:05d}", parts, looks)
            lettering.camera_rays_only(owned.add(library, f"Place {k:05d}", mesh))
    group = facing.node_group(shot, "Labels", library, settings.size, settings.distance)
    return facing.points(collection, "Places", places.position, group)


def _label(text: str, stem: float, font: bpy.types.VectorFont | None) -> list[Part]:
    """Letters (material 0) over their outline and the stem (1), one unit high, in the plane of x and y."""
    return [
        lettering.letters(text, stem, 0.0, 0.02, font, 0),
        lettering.letters(text, stem, RIM, 0.0, font, 1),
        lettering.stem(stem - 0.3, 0),
    ]
