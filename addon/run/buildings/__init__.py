"""Buildings from footprints: one rule for tilesets and for scenes.

A building is as high as its height says, else as its storeys, else as assumed. Its walls begin below the
lowest ground under its whole footprint, and its roof is level.
"""

from .footprints import ASSUMED, STOREY, Footprint, Footprints, collect, height_of, polygons, read
from .placement import Building, place_on_ground

__all__ = [
    "ASSUMED",
    "STOREY",
    "Building",
    "Footprint",
    "Footprints",
    "collect",
    "height_of",
    "place_on_ground",
    "polygons",
    "read",
]
