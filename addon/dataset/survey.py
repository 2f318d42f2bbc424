"""Survey of a place: positions of pixels on the ground and in the air, and of the front in the picture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..run import front, fronts
from ..run.burning import BURN_TIME
from ..run.fronts import Line
from ..shot import georeference
from ..shot.georeference import Georeference
from ..shot.shot import Shot
from ..shot.terrain.terrain import UNKNOWN, Terrain, box
from . import air
from .rendered import SampleCamera

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

STEEPEST = np.sin(np.radians(10.0))
"""Sine of the angle between view and ground, below which pixels have no area on the ground."""
LINE_TOLERANCE = 0.5
"""Maximum deviation of polylines, pixels."""

_RISE = 5.0  # m over which the slope of the ground is measured
_STEP, _LEAST_STEP = 8.0, 2.0  # pixels, and m, between points of a front in the picture
_MOST_POINTS = 4000  # of a front in the picture
_SIGHTS = 64  # points of a line of sight that are compared with the ground
_EDGE_ROWS, _EDGE_COLUMNS = 4, 4  # pixels above and below, and on each side, of an edge of the sky
_HIDDEN = 2.0  # m, height of the ground above a line of sight that hides its end
_NEAR = 1.0  # m before the camera
_DIGITS = 6  # of degrees in GeoJSON: 0.1 m
_FINE = 20.0  # m, largest chord of the front, which is curved within the cells of the model
_ISLAND = 600.0  # s, weight of the unburned share of ground compared with time to its arrival
_SIMPLIFIED = 0.25  # cells, largest deviation of the front in GeoJSON
_PER_DEGREE = 111_000.0  # m


@dataclass(frozen=True)
class Place:
    """Ground and fire of a sample.

    Attributes
    ----------
    georeference
        Place of the local metres on the Earth.
    ground
        z of the ground at x and y (n,), m.
    burns
        True where ground (n,) at x and y burned, or begins to burn soon.
    front
        Closed lines of the front (n, 2), degrees east and north.
    ignition
        Model time of the first fire, s; None without fire.
    tolerance
        Maximum deviation of the simplified front, m.
    """

    georeference: Georeference
    ground: Callable[[Array, Array], Array]
    burns: Callable[[Array, Array], Mask]
    front: tuple[Line, ...] = ()
    ignition: float | None = None
    tolerance: float = 5.0

    def height_above_sea(self, points: Array) -> Array:
        """Compute heights (n,) above mean sea level of local points (n, 3), m."""
        return self.georeference.above_sea(self.georeference.geodetic(points)[:, 2])

    def height_above_ground(self, points: Array) -> Array:
        """Compute heights (n,) of local points (n, 3) above the ground below them, m."""
        x, y, _ = points.T
        below = np.column_stack([x, y, self.ground(x, y)])
        heights: Array = self.georeference.geodetic(points)[:, 2] - self.georeference.geodetic(below)[:, 2]
        return heights

    def geojson(self) -> dict[str, Any] | None:
        """Return the front as a geometry of GeoJSON (RFC 7946), simplified; None without a front."""
        if not self.front:
            return None
        latitude = np.radians(self.georeference.latitude)
        scale = _PER_DEGREE / self.tolerance * np.array([np.cos(latitude), 1.0])
        lines = [np.round(fronts.simplify(line, scale), _DIGITS).tolist() for line in self.front]
        return {"type": "MultiLineString", "coordinates": lines}


def of_shot(shot: Shot, time: float) -> Place:
    """Survey the place of a shot at a model time, s."""
    ground, arrival = shot.bare_ground, shot.arrival
    first = float(np.nanmin(arrival)) if np.isfinite(arrival).any() else None

    def burns(x: Array, y: Array) -> Mask:
        row, column = ground.indices(*ground.geodetic(x, y))
        return ground.arrival_at(row, column) <= time + BURN_TIME

    tolerance = _SIMPLIFIED * min(ground.cell)
    return Place(georeference.resolve(shot), shot.ground.up, burns, _front(ground, time), first, tolerance)


def _front(ground: Terrain, time: float) -> tuple[Line, ...]:
    """Trace the front of the ground as drawn, at a model time, s.

    In a synthetic run the terrain invents unburned islands, so this front differs from the run's. After the
    last ground has burned out the front is empty.
    """
    last = np.max(ground.burn_time, initial=-np.inf, where=ground.burned >= 0.5)
    if time > last + BURN_TIME:
        return ()
    since, islands = ground.burn_time - time, _ISLAND * (0.5 - ground.burned)
    near = box(np.maximum(since, islands) <= 0.0, more=2)
    if near is None:
        return ()
    parts = max(1, int(np.ceil(max(ground.cell) / _FINE)))
    since, islands = (front.divide(each[near], parts) for each in (since, islands))
    row, column, after = front.contour(np.pad(np.maximum(since, islands), 1, constant_values=UNKNOWN))
    rows, columns = ((at - 1.0) / parts + lines.start for at, lines in zip((row, column), near, strict=True))
    return tuple(fronts.rings(*ground.places(rows, columns), after))


def rays(camera: SampleCamera, row: NDArray, column: NDArray) -> Array:
    """Compute directions (n, 3) through the centres of pixels (n,), of length 1 along the camera's axis."""
    x = (column + 0.5 - camera.cx) / camera.fx
    y = (camera.cy - row - 0.5) / camera.fy
    return np.column_stack([x, y, np.full(len(x), -1.0)]) @ camera.to_world[:3, :3].T


def at_range(camera: SampleCamera, row: NDArray, column: NDArray, away: NDArray) -> Array:
    """Compute the local points (n, 3) at distances (n,), m, along the rays of pixels (n,)."""
    ahead = rays(camera, row, column)
    return camera.to_world[:3, 3] + ahead * (away / np.linalg.norm(ahead, axis=1))[:, None]


def project(camera: SampleCamera, points: Array) -> tuple[Array, Array, Array]:
    """Project local points (n, 3): u, v in pixels and planar depth, m; u and v are NaN behind the camera."""
    x, y, z = ((points - camera.to_world[:3, 3]) @ camera.to_world[:3, :3]).T
    depth = np.where(-z > _NEAR, -z, np.nan)
    return camera.cx + camera.fx * x / depth, camera.cy - camera.fy * y / depth, -z


def ground_area(
    place: Place, camera: SampleCamera, row: NDArray, column: NDArray, depth: NDArray
) -> float | None:
    """Compute the area of the ground that pixels (n,) of a planar depth (n,), m, cover, in the map plane, m2.

    A pixel covers depth^2 / (fx fy) of a plane across the camera's axis, and depth^2 / (fx fy |n r|) of the
    map plane, with r from `rays` and the ground's normal n = (-dz/dx, -dz/dy, 1).

    Returns
    -------
    The area; None if the view is flatter than `STEEPEST` for most pixels: flames then hide the ground.
    """
    if not len(row):
        return None
    ahead = rays(camera, row, column)
    x, y = (camera.to_world[:3, 3] + ahead * depth[:, None])[:, :2].T
    half = 0.5 * _RISE
    slope_x = (place.ground(x + half, y) - place.ground(x - half, y)) / _RISE
    slope_y = (place.ground(x, y + half) - place.ground(x, y - half)) / _RISE
    normal = np.column_stack([-slope_x, -slope_y, np.ones(len(x))])
    facing = -np.sum(normal * ahead, axis=1)
    steep = facing / (np.linalg.norm(normal, axis=1) * np.linalg.norm(ahead, axis=1))
    if np.median(steep) < STEEPEST:
        return None
    seen = steep > 0.1 * STEEPEST
    return float(np.sum(depth[seen] ** 2 / facing[seen]) / (camera.fx * camera.fy))


def front_in_picture(
    place: Place, camera: SampleCamera, smoky: Mask, haze: float = 0.0, clearness: float = 0.0
) -> list[Array]:
    """Project the front: visible polylines (n, 2), pixels. Terrain, smoke and air hide it, trees do not.

    Parameters
    ----------
    smoky
        Pixels (h, w) whose smoke hides the ground.
    haze
        The sample's `light.haze`.
    clearness
        Least share of light that air lets pass from a visible front.
    """
    polylines, eye = [], camera.to_world[:3, 3]
    for line in place.front:
        for part in _sampled(place, camera, line):
            u, v, _ = project(camera, part)
            inside = (u >= 0.0) & (u <= camera.width) & (v >= 0.0) & (v <= camera.height)
            inside[inside] = ~smoky[_pixel(v[inside], camera.height), _pixel(u[inside], camera.width)]
            inside[inside] = air.clearness(haze, eye, part[inside]) >= clearness
            inside[inside] = _is_in_sight(place, camera, part[inside])
            polylines += [_simplified(np.column_stack([u, v])[run]) for run in _true_runs(inside)]
    return polylines


def skyline(depth: NDArray, picture: NDArray, contrast: float) -> list[Array]:
    """Trace the lower edge of the sky in a depth map (h, w): polylines (n, 2), pixels.

    In each column it is the first solid pixel from the top. Columns without sky at the top, of sky alone, or
    whose edge is not in the picture, divide the line.

    Parameters
    ----------
    picture
        (h, w, 3) in display values, 0..1.
    contrast
        Least difference between sky and land in the channel with the most.
    """
    solid = np.isfinite(depth)
    first = np.argmax(solid, axis=0)
    divided = solid.any(axis=0) & ~solid[0] & (_edge_contrast(picture, first) >= contrast)
    u = np.arange(depth.shape[1]) + 0.5
    return [_simplified(np.column_stack([u, first.astype(np.float64)])[run]) for run in _true_runs(divided)]


def _edge_contrast(picture: NDArray, first: NDArray) -> Array:
    """Compute the difference (w,) between means of a picture (h, w, 3) above and below rows `first` (w,)."""
    rows, columns = np.arange(1, _EDGE_ROWS + 1)[:, None], np.arange(len(first))
    above = picture[np.maximum(first - rows, 0), columns].mean(axis=0, dtype=np.float64)
    below = picture[np.minimum(first - 1 + rows, len(picture) - 1), columns].mean(axis=0, dtype=np.float64)
    wide = np.pad(below - above, ((_EDGE_COLUMNS, _EDGE_COLUMNS), (0, 0)), "edge")
    near = np.lib.stride_tricks.sliding_window_view(wide, 2 * _EDGE_COLUMNS + 1, axis=0)
    contrast: Array = np.abs(near.mean(axis=-1)).max(axis=-1)
    return contrast


def _sampled(place: Place, camera: SampleCamera, line: Line) -> list[Array]:
    """Return parts (n, 3) of a line near the picture on the ground, with points a few pixels apart."""
    corners = place.georeference.frame.forward(line[:, 1], line[:, 0], np.zeros(len(line)))
    corners[:, 2] = place.ground(corners[:, 0], corners[:, 1])
    u, v, depth = project(camera, corners)
    wide, high = camera.width, camera.height
    side = np.stack([u < 0.0, u > wide, v < 0.0, v > high, depth <= _NEAR])
    outside = np.any(side[:, :-1] & side[:, 1:], axis=0)
    parts = []
    for run in _true_runs(~outside, least=1):
        part = slice(run.start, run.stop + 1)
        parts.append(_divided(place, camera, corners[part]))
    return parts


def _divided(place: Place, camera: SampleCamera, corners: Array) -> Array:
    """Divide a line into steps of a few pixels at their nearest end, and place it on the ground."""
    lengths = np.hypot(*np.diff(corners[:, :2], axis=0).T)
    away = np.linalg.norm(corners - camera.to_world[:3, 3], axis=1)
    nearest = np.maximum(np.minimum(away[:-1], away[1:]) - lengths, 0.0)
    step = np.maximum(_STEP * nearest / camera.fx, _LEAST_STEP)
    counts = np.maximum(np.ceil(lengths / step), 1.0)
    if counts.sum() > _MOST_POINTS:
        counts = np.maximum(np.round(counts * _MOST_POINTS / counts.sum()), 1.0)
    ends = np.concatenate([[0.0], np.cumsum(counts)])
    at = np.arange(ends[-1] + 1.0)
    x, y = (np.interp(at, ends, corners[:, k]) for k in (0, 1))
    return np.column_stack([x, y, place.ground(x, y)])


def _is_in_sight(place: Place, camera: SampleCamera, points: Array) -> Mask:
    """Find the points (n, 3) on the ground that no terrain hides from the camera."""
    eye = camera.to_world[:3, 3]
    share = (np.arange(_SIGHTS) + 0.5) / _SIGHTS
    lines = eye + share[None, :, None] * (points - eye)[:, None, :]
    ground = place.ground(lines[..., 0].ravel(), lines[..., 1].ravel()).reshape(lines.shape[:2])
    return ~np.any(ground > lines[..., 2] + _HIDDEN, axis=1)


def _pixel(at: Array, size: int) -> NDArray[np.int64]:
    """Return the row or column of positions (n,) in pixels; the far edge is in the last one."""
    return np.minimum(at.astype(np.int64), size - 1)


def _true_runs(mask: Mask, least: int = 2) -> list[slice]:
    """Return the runs of at least `least` true values."""
    change = np.diff(np.concatenate([[0], mask.astype(np.int8), [0]]))
    bounds = zip(np.flatnonzero(change == 1), np.flatnonzero(change == -1), strict=True)
    return [slice(int(start), int(stop)) for start, stop in bounds if stop - start >= least]


def _simplified(line: Array) -> Array:
    """Simplify a polyline of pixels."""
    return fronts.simplify_open(line, np.full(2, 1.0 / LINE_TOLERANCE))
