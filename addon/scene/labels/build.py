"""Labels of place names: text that faces the camera, of constant size in the picture, faded with distance.

A label is a mesh one unit high: letters, an outline for contrast, and a stem down to the place. It is an
instance on a point of the ground, so objects in front of the place occlude it.
"""

from __future__ import annotations

import bpy
import numpy as np

from ...blender import owned
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...shot.stations import labels
from . import facing, lettering, material, town_lights
from .lettering import Part

# height of letters above the ground, and distance of rows, in letter heights
_STEM, _TIER = 2.2, 1.3


def build(shot: Shot, stage: Stage) -> bpy.types.Object | None:
    """Build "Firetwin Labels"; None if labels are off or without places."""
    collection, settings = stage.part("Labels"), shot.settings.labels
    places = labels.find(shot)
    if not places.names:
        return None
    towns = [place for place, kind in zip(places.position, places.kinds, strict=True) if kind == "town"]
    town_lights.build(shot, collection, np.reshape(towns, (-1, 3)))
    looks = [material.build(shot, name, colour) for name, colour in material.COLOURS.items()]
    library = owned.library("Place Names")
    size = lettering.legible_size(shot, settings.size)
    for k, parts in enumerate(forms(shot, places, size)):
        mesh = lettering.mesh(f"Firetwin Place {k:05d}", parts, looks)
        lettering.camera_rays_only(owned.add(library, f"Place {k:05d}", mesh))
    group = facing.node_group(shot, "Labels", library, size, settings.distance)
    return facing.points(collection, "Places", places.position, group)


def forms(shot: Shot, places: labels.Labels, size: float) -> list[list[Part]]:
    """Make the parts of each label, for letters of this height (picture heights)."""
    rows, rim = facing.tiers(shot, places.position), lettering.rim(shot, size)
    with lettering.typeface() as font:
        return [
            _label(name, _STEM + _TIER * int(row), rim, font)
            for name, row in zip(places.names, rows, strict=True)
        ]


def _label(text: str, stem: float, rim: float, font: bpy.types.VectorFont | None) -> list[Part]:
    """Make letters and stem (material 0) and their outline (1), one unit high, in the xy plane."""
    return [
        lettering.letters(text, stem, 0.0, 0.02, font, 0),
        lettering.letters(text, stem, rim, 0.0, font, 1),
        lettering.stem(stem - 0.3, 0),
    ]
