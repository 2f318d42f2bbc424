"""Buildings from footprints: one rule for tilesets and for scenes.

The height of a building is its property, or comes from its number of storeys, or is assumed. Walls begin
below the lowest ground under the footprint, and roofs are level.
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
