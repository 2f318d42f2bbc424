"""Small map of stations: hill shading, burned ground at a time, and dots; drawn by NumPy.

Blender, which shows it, has neither matplotlib nor Pillow. The map is a square with equal steps of latitude
and equal steps of longitude, true to scale at its centre. Pixels start in the south-west.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import ArrayLike, NDArray

from ..ellipsoid import metres_per_degree
from ..run import areas

SIDE = 512
"""Width and height of the map, pixels."""

RECENT = 1800.0  # s; ground that burned in this time is shown as the fire
_MARGIN = 0.05  # margin around the content, of half the map's width
_AROUND = 1.0  # distance from the run to which stations are shown, in sizes of the run
_EMPTY = (0.30, 0.31, 0.32)  # beyond the run
_GROUND, _BURNED, _FIRE = (0.80, 0.78, 0.70), (0.22, 0.18, 0.17), (0.98, 0.42, 0.08)  # by eye
_SHARE = 0.85  # share of the colour of burned ground, over the shading
_DOT, _RIM, _RING = 4.0, 5.5, (8.5, 11.0)  # pixels: radius of a dot, with its rim; of the ring around one
COLOURS = {"fact": (0.95, 0.95, 0.92), "exercise": (1.0, 0.70, 0.15), "user": (0.45, 0.75, 1.0)}
"""Colours of dots by origin: white, amber, blue, as on signs."""

Array = NDArray[np.float64]
Pixels = NDArray[np.float32]


@dataclass(frozen=True)
class RunTerrain:
    """Terrain of a run: axes (ny,), (nx,), degrees; elevation (ny, nx), m; arrival time (ny, nx), s.

    The arrival time is NaN in cells that never burn.
    """

    latitude: Array
    longitude: Array
    elevation: NDArray[np.floating]
    arrival: NDArray[np.floating]


@dataclass(frozen=True)
class MapPicture:
    """Static content of a map: extent, shaded ground (SIDE, SIDE, 3), and arrival times, s."""

    south: float
    north: float
    west: float
    east: float
    ground: Pixels
    arrival: Array

    def pixels(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Return fractional rows and columns of points; points beyond the map are outside of its pixels."""
        turned = areas.turned(longitude, 0.5 * (self.west + self.east))
        row = (np.asarray(latitude, np.float64) - self.south) / (self.north - self.south)
        column = (turned - self.west) / (self.east - self.west)
        return row * SIDE - 0.5, column * SIDE - 0.5

    def nearest(self, latitude: ArrayLike, longitude: ArrayLike, at: tuple[float, float]) -> int | None:
        """Return the index of the point nearest to a position on the map, (up, along) from 0 to 1."""
        row, column = self.pixels(latitude, longitude)
        far = np.hypot(row + 0.5 - at[0] * SIDE, column + 0.5 - at[1] * SIDE)
        return int(np.argmin(far)) if far.size else None


def prepare_map(field: RunTerrain | None, latitude: ArrayLike, longitude: ArrayLike) -> MapPicture | None:
    """Prepare the map of a run's ground and of the stations around it; None without either."""
    y, x = np.asarray(latitude, np.float64), np.asarray(longitude, np.float64)
    if field is None and not y.size:
        return None
    middle = float(x[0]) if field is None else 0.5 * float(field.longitude[0] + field.longitude[-1])
    south, north, west, east = _box(field, y, areas.turned(x, middle))
    up, along = metres_per_degree(0.5 * (south + north))
    half = (1.0 + _MARGIN) * max(0.5 * (north - south) * up, 0.5 * (east - west) * along, 1000.0)
    y0, x0 = 0.5 * (south + north), 0.5 * (west + east)
    south, north, west, east = y0 - half / up, y0 + half / up, x0 - half / along, x0 + half / along
    ground = np.broadcast_to(np.array(_EMPTY, np.float32), (SIDE, SIDE, 3)).copy()
    arrival = np.full((SIDE, SIDE), np.nan)
    if field is not None:
        _draw_ground(field, (south, north, west, east), ground, arrival)
    return MapPicture(south, north, west, east, ground, arrival)


def draw(
    plan: MapPicture,
    time: float,
    latitude: ArrayLike,
    longitude: ArrayLike,
    origins: list[str],
    selected: int | None,
) -> Pixels:
    """Draw the picture (SIDE, SIDE, 4), sRGB and alpha from 0 to 1, south first.

    Parameters
    ----------
    time
        Model time, s.
    origins
        Origin of each station (n,), shown by the colour of its dot.
    selected
        Index of the selected station, which has a ring.
    """
    picture = np.ones((SIDE, SIDE, 4), np.float32)
    picture[..., :3] = plan.ground
    with np.errstate(invalid="ignore"):
        burned, fire = plan.arrival <= time, (plan.arrival <= time) & (plan.arrival > time - RECENT)
    for mask, colour in ((burned & ~fire, _BURNED), (fire, _FIRE)):
        picture[mask, :3] += _SHARE * (np.array(colour, np.float32) - picture[mask, :3])
    row, column = plan.pixels(latitude, longitude)
    for y, x, origin in zip(row.tolist(), column.tolist(), origins, strict=True):
        _draw_ring(picture, y, x, 0.0, _RIM, (0.05, 0.05, 0.05))
        _draw_ring(picture, y, x, 0.0, _DOT, COLOURS[origin])
    if selected is not None:
        y, x = float(row[selected]), float(column[selected])
        _draw_ring(picture, y, x, _RING[0] - 1.5, _RING[1] + 1.5, (0.05, 0.05, 0.05))
        _draw_ring(picture, y, x, *_RING, (1.0, 1.0, 1.0))
    return picture


def _box(field: RunTerrain | None, y: Array, x: Array) -> tuple[float, float, float, float]:
    """Return south, north, west and east of the run and of the stations near it."""
    if field is None:
        return float(y.min()), float(y.max()), float(x.min()), float(x.max())
    (south, north), (west, east) = (np.sort(axis[[0, -1]]) for axis in (field.latitude, field.longitude))
    up, along = _AROUND * (north - south), _AROUND * (east - west)
    near = (y >= south - up) & (y <= north + up) & (x >= west - along) & (x <= east + along)
    y, x = (np.concatenate([each[near], ends]) for each, ends in ((y, [south, north]), (x, [west, east])))
    return float(y.min()), float(y.max()), float(x.min()), float(x.max())


def _draw_ground(
    field: RunTerrain, box: tuple[float, float, float, float], ground: Pixels, arrival: Array
) -> None:
    """Draw the shaded ground and the arrival times of the run onto the map."""
    south, north, west, east = box
    centre = (np.arange(SIDE) + 0.5) / SIDE
    row = _index(field.latitude, south + centre * (north - south))
    column = _index(field.longitude, west + centre * (east - west))
    rows, columns = np.flatnonzero(np.isfinite(row)), np.flatnonzero(np.isfinite(column))
    if not (rows.size and columns.size):
        return
    inside, at = np.ix_(rows, columns), np.meshgrid(row[rows], column[columns], indexing="ij")
    height = bilinear(np.nan_to_num(field.elevation), *at).reshape(len(rows), len(columns))
    up, along = metres_per_degree(0.5 * (south + north))
    step = (north - south) * up / SIDE, (east - west) * along / SIDE
    ground[inside] = shade(height, step)[..., None] * np.array(_GROUND, np.float32)
    whole = (np.rint(each).astype(np.int64) for each in (row[rows], column[columns]))
    arrival[inside] = field.arrival[np.ix_(*whole)]


def shade(height: Array, step: tuple[float, float]) -> Pixels:
    """Compute hill shading (h, w) from 0.3 to 1 of heights, m, lit from the north-west at 45 degrees.

    Lambert's cosine law with heights exaggerated by 2; `step` is the size of a pixel upwards and along, m.
    """
    if min(height.shape) < 2:
        return np.full(height.shape, 0.8, np.float32)
    up, along = (2.0 * each for each in np.gradient(height, *step))
    light = 0.5 * (along - up) + np.sqrt(0.5)  # towards west and north, and upwards
    return (0.3 + 0.7 * np.clip(light / np.sqrt(1.0 + up**2 + along**2), 0.0, 1.0)).astype(np.float32)


def _index(axis: Array, at: Array) -> Array:
    """Return the fractional index of values along an axis; NaN beyond the edges of its cells."""
    order = 1 if axis[-1] >= axis[0] else -1
    places = np.arange(len(axis), dtype=np.float64)[::order]
    found = np.interp(at, axis[::order], places)
    edges = np.sort(areas.edges(axis)[[0, -1]])
    return np.where((at >= edges[0]) & (at <= edges[1]), found, np.nan)


def _draw_ring(
    picture: Pixels, row: float, column: float, inner: float, outer: float, colour: tuple[float, ...]
) -> None:
    """Draw a ring or a disc with antialiased edges, clipped to the picture."""
    reach = int(np.ceil(outer)) + 1
    if not (-reach < row < SIDE + reach and -reach < column < SIDE + reach):
        return
    low, left = max(int(row) - reach, 0), max(int(column) - reach, 0)
    part = picture[low : int(row) + reach + 1, left : int(column) + reach + 1, :3]
    y, x = np.ogrid[low : low + part.shape[0], left : left + part.shape[1]]
    far = np.hypot(y - row, x - column)
    cover = np.clip(outer + 0.5 - far, 0.0, 1.0) * np.clip(far - inner + 0.5 + (inner == 0.0), 0.0, 1.0)
    part += cover[..., None].astype(np.float32) * (np.array(colour, np.float32) - part)
