"""Footprints of a file, and how high each building is.

Heights come from the footprint's own properties, or its number of storeys. What has neither gets a height
that is reported. Sources of property names: OpenStreetMap wiki, "Simple 3D Buildings"; building footprints
of Microsoft and Overture.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...errors import input_error
from ..observations import Detections, features
from ..observations.feature import Feature, finite
from . import rings
from .rings import Array, Rings

STOREY = 3.2
"""m, height of a storey where only their number is known."""
ASSUMED = 5.0
"""m, height of a building that says neither height nor storeys."""
_HEIGHT = ("height", "building:height", "render_height", "building_height")
_STOREYS = ("building:levels", "levels", "num_floors", "storeys", "stories")
_HIGHEST = 900.0  # m; above, a height is no building's


@dataclass(frozen=True)
class Footprint:
    """Outline of a building.

    Attributes
    ----------
    outer, holes
        Rings (n, 2), east and north, in degrees or metres, not closed; the outer one is anticlockwise, holes
        are clockwise.
    height
        m above the ground.
    number
        Of the building in its file, from 0: parts of one building have the same.
    """

    outer: Array
    holes: Rings
    height: float
    number: int = 0

    @property
    def rings(self) -> Rings:
        """The outer ring and the holes."""
        return (self.outer, *self.holes)


@dataclass(frozen=True)
class Footprints:
    """Footprints of a file, and what had to be assumed, mended or left out.

    Attributes
    ----------
    assumed
        Buildings without a height, which got `ASSUMED`.
    mended
        Polygons that crossed themselves, and were split.
    refused
        Polygons that crossed themselves, and are left out, because shapely is not there to split them.
    """

    outlines: tuple[Footprint, ...]
    assumed: int = 0
    mended: int = 0
    refused: int = 0

    def summary(self) -> str:
        """In words."""
        parts = [f"footprints of buildings: {len(self.outlines)}"]
        if self.assumed:
            parts.append(f"{self.assumed} without a height are {ASSUMED:g} m high")
        if self.mended:
            parts.append(f"{self.mended} crossed themselves and were split")
        if self.refused:
            parts.append(f"{self.refused} cross themselves and are left out (shapely splits them)")
        return "; ".join(parts)


def height_of(properties: Mapping[str, Any]) -> float | None:
    """Height that a building's properties give, m; None where they give none that a building can have."""
    words = {str(name).lower(): str(value).lower() for name, value in properties.items()}
    for names, unit in ((_HEIGHT, 1.0), (_STOREYS, STOREY)):
        for name in names:
            value = finite(words.get(name, "").removesuffix("m").strip())
            if value is not None and 0.0 < value * unit < _HIGHEST:
                return value * unit
    return None


def collect(known: Iterable[tuple[tuple[Rings, ...], float | None]]) -> Footprints:
    """Footprints of buildings: polygons and height (None: not known) of each."""
    outlines: list[Footprint] = []
    assumed = mended = refused = 0
    for number, (polygons, height) in enumerate(known):
        assumed += height is None
        for polygon in polygons:
            whole = rings.mended(polygon)
            if whole is None:
                refused += 1
                continue
            parts, changed = whole
            mended += changed
            outlines += [Footprint(part[0], part[1:], height or ASSUMED, number) for part in parts]
    return Footprints(tuple(outlines), assumed, mended, refused)


def polygons(path: Path) -> list[Feature]:
    """Features with polygons of a file, such as GeoJSON, GeoPackage, KML or a shapefile.

    Raises
    ------
    InputError
        The file is of another kind or damaged, or has no polygons.
    """
    found = features(path)
    having = [] if isinstance(found, Detections) else [each for each in found if each.polygons]
    if not having:
        raise input_error(path, "has no polygons; footprints of buildings are polygons")
    return having


def read(path: Path) -> Footprints:
    """Read the footprints of a file, every polygon of which is a building.

    Raises
    ------
    InputError
        See `polygons`.
    """
    return collect((each.polygons, height_of(each.properties)) for each in polygons(path))
