"""Building footprints of a file, with heights.

Heights come from properties of the footprint, or from its number of storeys. Other buildings get an assumed
height, which is reported. Sources of property names: OpenStreetMap wiki, "Simple 3D Buildings"; building
footprints of Microsoft and Overture.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ... import limits
from ...errors import Error, input_error
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
_HIGHEST = 900.0  # m, above which a height is invalid


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
        Number of the building in its file, from 0; parts of one building share it.
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
    """Footprints of a file, with counts of assumed heights, and of repaired and rejected polygons.

    Attributes
    ----------
    assumed
        Number of buildings without a height, which have height `ASSUMED`.
    mended
        Number of self-intersecting polygons, which were split.
    refused
        Number of self-intersecting polygons that were omitted, because shapely is not installed.
    too_large
        Number of polygons that were omitted for more than `limits.CORNERS` corners.
    """

    outlines: tuple[Footprint, ...]
    assumed: int = 0
    mended: int = 0
    refused: int = 0
    too_large: int = 0

    def summary(self) -> str:
        """Describe the result in a sentence."""
        parts = [f"footprints of buildings: {len(self.outlines)}"]
        if self.assumed:
            parts.append(f"{self.assumed} without a height are {ASSUMED:g} m high")
        if self.mended:
            parts.append(f"{self.mended} crossed themselves and were split")
        if self.refused:
            parts.append(f"{self.refused} cross themselves and are left out (shapely splits them)")
        if self.too_large:
            parts.append(f"{self.too_large} have more than {limits.CORNERS:,} corners and are left out")
        return "; ".join(parts)


def height_of(properties: Mapping[str, Any]) -> float | None:
    """Find the height of a building in its properties, m; None if they have no plausible height."""
    words = {str(name).lower(): str(value).lower() for name, value in properties.items()}
    for names, unit in ((_HEIGHT, 1.0), (_STOREYS, STOREY)):
        for name in names:
            value = finite(words.get(name, "").removesuffix("m").strip())
            if value is not None and 0.0 < value * unit < _HIGHEST:
                return value * unit
    return None


def collect(collected: Iterable[tuple[tuple[Rings, ...], float | None]]) -> Footprints:
    """Convert polygons and heights (None: unknown) of buildings to footprints.

    Raises
    ------
    Error
        They have more than `limits.FOOTPRINT_CORNERS` corners.
    """
    outlines: list[Footprint] = []
    assumed = mended = refused = too_large = corners = 0
    for number, (polygons, height) in enumerate(collected):
        assumed += height is None
        for polygon in polygons:
            corners += (here := sum(map(len, polygon)))
            if corners > limits.FOOTPRINT_CORNERS:
                most = f"more than {limits.FOOTPRINT_CORNERS:,}"
                raise Error(f"footprints of buildings have {most} corners; cut out the area of the scene")
            if here > limits.CORNERS:
                too_large += 1
                continue
            whole = rings.mended(polygon)
            if whole is None:
                refused += 1
                continue
            parts, changed = whole
            mended += changed
            outlines += [Footprint(part[0], part[1:], height or ASSUMED, number) for part in parts]
    return Footprints(tuple(outlines), assumed, mended, refused, too_large)


def polygons(path: Path) -> list[Feature]:
    """Read the features with polygons of a file, such as GeoJSON, GeoPackage, KML or a shapefile.

    Raises
    ------
    InputError
        The file has another format, is damaged, or has no polygons.
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
