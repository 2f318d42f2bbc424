"""Buildings from footprints: how high each is, and where it stands on the ground.

Heights come from the footprint's own properties, or its number of storeys. What has neither gets a height
that is reported. Sources of property names: OpenStreetMap wiki, "Simple 3D Buildings"; building footprints
of Microsoft and Overture.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ..ellipsoid import metres_per_degree
from ..errors import Error, input_error
from ..run.observations import geojson, geopackage, shapefile
from ..run.observations.feature import Feature, Polygon, finite

Array = NDArray[np.float64]
STOREY = 3.2
"""m, height of a storey where only their number is known."""
ASSUMED = 5.0
"""m, height of a building that says neither height nor storeys."""
_HEIGHT = ("height", "building:height", "render_height", "building_height")
_STOREYS = ("building:levels", "levels", "num_floors", "storeys", "stories")
_HIGHEST = 900.0  # m; above, a height is no building's
_SKIRT = 0.5  # m that walls reach into the ground
_LEAST = 1.0  # m that a roof stands above the highest ground beneath it
_SAMPLE = 3.0  # m between samples of the ground
_READERS = {".geojson": geojson.read, ".json": geojson.read, ".gpkg": geopackage.read, ".shp": shapefile.read}


@dataclass(frozen=True)
class Footprint:
    """Outline of a building.

    Attributes
    ----------
    outer, holes
        Rings (n, 2), degrees east and north, not closed; the outer one is anticlockwise, holes are clockwise.
    height
        m above the ground.
    """

    outer: Array
    holes: tuple[Array, ...]
    height: float


@dataclass(frozen=True)
class Building:
    """A footprint that stands on the ground.

    Attributes
    ----------
    base, roof
        m above the ellipsoid, or whatever the ground's heights are above.
    middle
        Degrees east and north, of a point inside.
    """

    outer: Array
    holes: tuple[Array, ...]
    height: float
    base: float
    roof: float
    middle: tuple[float, float]


@dataclass(frozen=True)
class Footprints:
    """Footprints of a file, and what had to be assumed or mended.

    Attributes
    ----------
    assumed
        Footprints without a height, which got `ASSUMED`.
    mended
        Polygons that crossed themselves, and were split.
    """

    outlines: tuple[Footprint, ...]
    assumed: int
    mended: int


def read(path: Path) -> Footprints:
    """Read the polygons of a GeoJSON, GeoPackage or shapefile.

    Raises
    ------
    InputError
        The file is of another kind or damaged, or has no polygons.
    """
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise input_error(path, 0, 0, "is no GeoJSON, GeoPackage or shapefile; convert it with ogr2ogr")
    outlines: list[Footprint] = []
    assumed = mended = 0
    for feature in reader(path):
        height = _height(feature)
        for polygon in feature.polygons:
            parts, changed = _valid(polygon)
            mended += changed
            assumed += height is None
            outlines += [Footprint(outer, holes, height or ASSUMED) for outer, holes in parts]
    if not outlines:
        raise input_error(path, 0, 0, "has no polygons; footprints of buildings are polygons")
    return Footprints(tuple(outlines), assumed, mended)


def stand(outlines: Sequence[Footprint], ground: Callable[[Array, Array], Array]) -> list[Building]:
    """Put buildings on the ground.

    Walls begin below the lowest ground under the whole footprint. The roof is level: as high as the building
    above the ground at its middle, and above all ground beneath it.

    Parameters
    ----------
    ground
        Heights (n,), m, at latitudes and longitudes (n,) in degrees.
    """
    return [_stand(each, ground) for each in outlines]


def triangles(outer: Array, holes: Sequence[Array]) -> Array:
    """Triangles (t, 3, 2) of a polygon, counter-clockwise (constrained Delaunay, by GEOS)."""
    shapely = _library()
    parts = shapely.constrained_delaunay_triangles(shapely.Polygon(outer, holes)).geoms
    return np.array([np.asarray(shapely.normalize(part).exterior.reverse().coords)[:3] for part in parts])


def _library() -> ModuleType:
    try:
        import shapely
    except ImportError:
        raise Error("buildings need the Python package shapely: pip install 'firetwin[score]'") from None
    return shapely


def _height(feature: Feature) -> float | None:
    """Height that a footprint gives, m; None where it gives none that a building can have."""
    for names, unit in ((_HEIGHT, 1.0), (_STOREYS, STOREY)):
        for name in names:
            text = str(feature.properties.get(name, "")).removesuffix("m").strip()
            if (value := finite(text)) is not None and 0.0 < value * unit < _HIGHEST:
                return value * unit
    return None


def _valid(polygon: Polygon) -> tuple[list[tuple[Array, tuple[Array, ...]]], bool]:
    """Rings of a polygon that cross nothing, and whether they had to be changed."""
    shapely = _library()
    outer, *holes = polygon
    shape = shapely.Polygon(outer, holes)
    changed = not shape.is_valid
    whole = shapely.make_valid(shape) if changed else shape
    parts = [
        part for part in getattr(whole, "geoms", [whole]) if part.geom_type == "Polygon" and part.area > 0.0
    ]
    found = []
    for part in parts:
        turned = shapely.geometry.polygon.orient(part)
        rings = [np.asarray(ring.coords)[:-1] for ring in (turned.exterior, *turned.interiors)]
        found.append((rings[0], tuple(rings[1:])))
    return found, changed


def _stand(footprint: Footprint, ground: Callable[[Array, Array], Array]) -> Building:
    shapely = _library()
    shape = shapely.Polygon(footprint.outer, footprint.holes)
    middle = shape.representative_point()
    inside = _samples(shape)
    places = np.vstack([[(middle.x, middle.y)], footprint.outer, *footprint.holes, inside])
    heights = ground(places[:, 1], places[:, 0])
    return Building(
        outer=footprint.outer,
        holes=footprint.holes,
        height=footprint.height,
        base=float(heights.min()) - _SKIRT,
        roof=max(float(heights[0]) + footprint.height, float(heights.max()) + _LEAST),
        middle=(middle.x, middle.y),
    )


def _samples(shape: object) -> Array:
    """Points (n, 2) inside a polygon, at most `_SAMPLE` metres apart up to 32 along a side."""
    shapely = _library()
    west, south, east, north = shape.bounds  # type: ignore[attr-defined]
    scale = metres_per_degree(south)
    counts = [
        int(np.clip(np.ceil(length * metres / _SAMPLE), 1, 32))
        for length, metres in zip((north - south, east - west), scale, strict=True)
    ]
    lat, lon = np.linspace(south, north, counts[0] + 1), np.linspace(west, east, counts[1] + 1)
    points = np.stack(np.meshgrid(lon, lat), axis=-1).reshape(-1, 2)
    return points[shapely.contains_xy(shape, points[:, 0], points[:, 1])]
