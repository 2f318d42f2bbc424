"""Fire polygons: observed perimeters, fronts of a run, and distances between perimeters (m)."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from ... import extras
from ...errors import UsageError
from .. import areas
from ..arrival_grid import NEVER, fill_unburned, pad_axis
from ..observations import Perimeter

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry


def needed() -> None:
    """Check that the packages for scores are installed.

    Raises
    ------
    UsageError
        A package is missing.
    """
    try:
        import contourpy  # noqa: F401 (of matplotlib)
        import pyproj  # noqa: F401
        import shapely  # noqa: F401
    except ModuleNotFoundError as error:
        pip = extras.install("score")
        raise UsageError(f"scores need {error.name}; install it with: {pip}") from None


class Projection:
    """Lambert azimuthal equal-area projection on WGS84 about a point; distances are true within 1e-5."""

    def __init__(self, latitude: float, longitude: float) -> None:
        from pyproj import Transformer

        self.definition = f"+proj=laea +lat_0={latitude:.6f} +lon_0={longitude:.6f} +datum=WGS84 +units=m"
        self._there = Transformer.from_crs("EPSG:4326", self.definition, always_xy=True)

    def project(self, shape: BaseGeometry, back: bool = False) -> BaseGeometry:
        """Project a shape from degrees to metres, or back."""
        import shapely

        way = "INVERSE" if back else "FORWARD"

        def move(points: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.column_stack(self._there.transform(points[:, 0], points[:, 1], direction=way))

        return clean(shapely.transform(shape, move))

    def points(self, longitude: NDArray[np.float64], latitude: NDArray[np.float64]) -> NDArray[Any]:
        """Project points in degrees."""
        import shapely

        return shapely.points(*self._there.transform(longitude, latitude))


def of_perimeter(perimeter: Perimeter, middle: float) -> BaseGeometry:
    """Convert a perimeter to one valid shape in degrees, with longitudes near `middle`."""
    import shapely

    def near(ring: NDArray[np.float64]) -> NDArray[np.float64]:
        turned = areas.turned(ring[:, :1].mean(), middle) - ring[:, :1].mean()
        return ring + np.array([float(turned), 0.0])

    polygons = [
        shapely.Polygon(near(rings[0]), [near(hole) for hole in rings[1:]]) for rings in perimeter.polygons
    ]
    return shapely.union_all([clean(polygon) for polygon in polygons])


def clean(shape: BaseGeometry) -> BaseGeometry:
    """Repair polygons: split rings that intersect themselves."""
    import shapely

    if not shape.is_valid:
        shape = shapely.make_valid(shape)
    parts = [part for part in shapely.get_parts(shape) if part.geom_type in ("Polygon", "MultiPolygon")]
    return shapely.union_all(parts) if len(parts) != 1 else parts[0]


def collected(shapes: Iterable[BaseGeometry]) -> BaseGeometry:
    """Collect shapes in one multi-part shape, overlapping or not."""
    import shapely

    return shapely.GeometryCollection(list(shapes))


def outline(x: NDArray[np.float64], y: NDArray[np.float64]) -> BaseGeometry:
    """Build a rectangle in degrees with a vertex at each cell edge, as parallels curve in projection."""
    import shapely

    west, east = np.full_like(y, x[0]), np.full_like(y, x[-1])
    south, north = np.full_like(x, y[0]), np.full_like(x, y[-1])
    rim = [(x, south), (east, y), (x[::-1], north[::-1]), (west[::-1], y[::-1])]
    return shapely.Polygon(np.vstack([np.column_stack(side) for side in rim]))


def contains(
    shape: BaseGeometry, longitude: NDArray[np.float64], latitude: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Mask (ny, nx) of cell centres within a shape in degrees."""
    import shapely

    mask = np.zeros((latitude.size, longitude.size), bool)
    if shape.is_empty:
        return mask
    west, south, east, north = shape.bounds
    rows = np.flatnonzero((latitude >= south) & (latitude <= north))
    columns = np.flatnonzero((longitude >= west) & (longitude <= east))
    if rows.size and columns.size:
        shapely.prepare(shape)
        x, y = np.meshgrid(longitude[columns], latitude[rows])
        mask[np.ix_(rows, columns)] = shapely.contains_xy(shape, x, y)
    return mask


def of_front(
    longitude: NDArray[np.float64], latitude: NDArray[np.float64], since: NDArray[np.float64]
) -> BaseGeometry:
    """Trace the burned polygon in degrees: where `since`, arrival minus time (s), is 0 or less.

    The front is interpolated linearly between two cells. It is half-way between a burned cell and one that
    never burns (NaN) or the grid's edge: such a cell takes the negated mean of its burned neighbours.
    """
    import contourpy
    import shapely

    if not (since <= 0.0).any():
        return shapely.Polygon()
    field = fill_unburned(np.pad(since, 1, constant_values=np.nan))
    x, y = (pad_axis(axis) for axis in (longitude, latitude))
    front = contourpy.contour_generator(x, y, field, fill_type=contourpy.FillType.OuterOffset)
    polygons, offsets = cast(tuple[list[NDArray], list[NDArray]], front.filled(-NEVER, 0.0))
    outlines = []
    for points, starts in zip(polygons, offsets, strict=True):
        rings = [points[a:b] for a, b in itertools.pairwise(starts)]
        outlines.append(shapely.Polygon(rings[0], [hole for hole in rings[1:] if len(hole) > 3]))
    return clean(shapely.MultiPolygon(outlines))


def distances(run: BaseGeometry, seen: BaseGeometry, step: float) -> dict[str, float | None]:
    """Compute distances (m) between two projected perimeters, with holes, sampled every `step` m.

    The Hausdorff distance is the largest distance of any point to the other perimeter; the mean is over all
    points of both. None if one is empty.
    """
    if run.is_empty or seen.is_empty:
        return {"hausdorff": None, "mean": None, "run_to_observed": None, "observed_to_run": None}
    there, back = (
        _distances_to(run.boundary, seen.boundary, step),
        _distances_to(seen.boundary, run.boundary, step),
    )
    return {
        "hausdorff": float(max(there.max(), back.max())),
        "mean": float(np.concatenate([there, back]).mean()),
        "run_to_observed": float(there.mean()),
        "observed_to_run": float(back.mean()),
    }


def _distances_to(line: BaseGeometry, other: BaseGeometry, step: float) -> NDArray[np.float64]:
    """Compute distances of points along a line, vertices included, to another line."""
    import shapely

    points = shapely.get_coordinates(shapely.segmentize(line, step))
    tree = shapely.STRtree(_pieces(other))
    return tree.query_nearest(shapely.points(points), return_distance=True, all_matches=False)[1]


def _pieces(line: BaseGeometry) -> Iterable[Any]:
    """List the straight segments of a line."""
    import shapely

    pieces = []
    for part in shapely.get_parts(line):
        corners = shapely.get_coordinates(part)
        pieces.append(shapely.linestrings(np.stack([corners[:-1], corners[1:]], axis=1)))
    return np.concatenate(pieces)
