"""Plan of an orthophoto: the server's tiles that a shot needs, with levels by the nearest views."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...tiles.imagery import mercator
from ...tiles.imagery.mosaic import Patch
from ..terrain.raster import Array
from .photo_areas import areas_of

if TYPE_CHECKING:
    from ..shot import Shot

_RADII = (16.0, 4.0, 1.0, 0.25)  # of areas near the cameras, in units of `terrain.near_radius`
_LATTICE = 64  # cells along an area in which its distance from cameras is measured
_SLOPE = 0.7  # of a camera's height above the ground: how near ground of 45 degrees may be to it
_NEAREST = 1.0  # m
_EDGE = 33  # points along an area's edge that its degrees come from
_FINEST = 1.0e-3  # m

Bounds = tuple[float, float, float, float]


@dataclass(frozen=True)
class PlannedArea:
    """An area, its tiles, and the reason for their level.

    Attributes
    ----------
    low, high
        Corners (2,), m.
    step
        Size of a texel on the ground, m.
    wanted
        Size of a pixel on the ground where a view is nearest, m; infinite without a view of the area.
    limited
        Limit that made texels larger than `wanted`: "", "level" (server) or "size" (picture).
    """

    low: Array
    high: Array
    patch: Patch
    step: float
    wanted: float
    limited: str


def plan(shot: Shot, bounds: Bounds, levels: tuple[int, int], side: int) -> list[PlannedArea]:
    """Plan areas with their tiles: all ground first, then finer areas nearer to the cameras.

    A texel is at most one pixel of the nearest view, unless the server's finest level or `terrain.photo_size`
    end before.

    Parameters
    ----------
    bounds
        West, south, east and north of the area that the server covers, degrees.
    levels
        Coarsest and finest level of the server.
    side
        Pixels along its tiles.
    """
    fields = shot.ground.fields
    finest = mercator.texel(float(np.abs(fields.latitude).max()), levels[1], side)
    step = max(finest, _FINEST)
    planned: list[PlannedArea] = []
    for area in areas_of(shot, bounds, step, _RADII):
        found = _planned(shot, *area, levels, side, bounds)
        if not planned or found.patch.level > planned[-1].patch.level:
            planned.append(found)
    return planned


def pixel_at_nearest_view(shot: Shot, low: Array, high: Array) -> float:
    """Smallest size of a pixel (m) on ground that a view sees in an area; infinite if none does.

    The ground's cells count as near as their bounding spheres, so the size errs to the small side.
    """
    steps = (high - low) / _LATTICE
    east, north = (v.ravel() for v in np.meshgrid(*(
        low[k] + (np.arange(_LATTICE) + 0.5) * steps[k] for k in (0, 1)
    )))  # fmt: skip
    up = shot.ground.up(east, north)
    rise = np.abs(np.gradient(up.reshape(_LATTICE, _LATTICE))).sum(axis=0).ravel()
    radius = 0.5 * np.hypot(np.hypot(*steps), rise)
    place = np.column_stack([east, north, up])
    seen = np.asarray(shot.visibility.visible_mask(place, radius))
    if not seen.any():
        return np.inf
    sizes = [np.inf]
    for path in shot.paths:
        if not path.perspective:
            sizes.append(path.pixel)
            continue
        eyes = path.position[shot.filmed(path)]
        above = _SLOPE * (eyes[:, 2] - shot.ground.up(*eyes[:, :2].T))
        away = shot.visibility.distance_from(path, place[seen]) - radius[seen]
        sizes.append(path.pixel * max(float(away.min()), float(above.min(initial=np.inf)), _NEAREST))
    return float(min(sizes))


def _planned(
    shot: Shot, low: Array, high: Array, levels: tuple[int, int], side: int, bounds: Bounds
) -> PlannedArea:
    south, west, north, east = _degrees(shot, low, high)
    south, north = max(south, bounds[1]), min(north, bounds[3])
    nearest = 0.0 if south < 0.0 < north else min(abs(south), abs(north))  # where texels are largest
    wanted = pixel_at_nearest_view(shot, low, high)
    level = mercator.level_for(wanted, nearest, side) if np.isfinite(wanted) else levels[0]
    limited = ""
    if level > levels[1]:
        level, limited = levels[1], "level"
    while (
        level > levels[0] and _span(south, west, north, east, level) * side > shot.settings.terrain.photo_size
    ):
        level, limited = level - 1, "size"
    level = max(level, levels[0])
    patch = _patch(south, west, north, east, level)
    return PlannedArea(low, high, patch, mercator.texel(nearest, level, side), wanted, limited)


def _degrees(shot: Shot, low: Array, high: Array) -> tuple[float, float, float, float]:
    """South, west, north and east of an area, from points all over it; longitudes may pass 180 degrees."""
    axes = (np.linspace(low[k], high[k], _EDGE) for k in (0, 1))
    latitude, longitude = shot.ground.geodetic(*(v.ravel() for v in np.meshgrid(*axes)))
    return float(latitude.min()), float(longitude.min()), float(latitude.max()), float(longitude.max())


def _span(south: float, west: float, north: float, east: float, level: int) -> float:
    """Longer side of a box in tiles."""
    (left, right), (bottom, top) = mercator.tile_at([south, north], [west, east], level)
    return float(max(right - left, bottom - top))


def _patch(south: float, west: float, north: float, east: float, level: int) -> Patch:
    """Tiles that cover a box, with half a texel more for bilinear values at its edge."""
    (left, right), (bottom, top) = mercator.tile_at([south, north], [west, east], level)
    more = 1.0 / 256.0
    columns = int(np.floor(left - more)), int(np.floor(right + more)) + 1
    rows = int(np.floor(top - more)), int(np.floor(bottom + more)) + 1
    return Patch(level, columns, (max(rows[0], 0), min(rows[1], 1 << level)))
