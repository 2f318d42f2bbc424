"""Map of flame length over the ground, from which flames near a camera are drawn as a volume.

Needs no Blender.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from firetwin_core import constants
from firetwin_core.terrain import bilinear
from numpy.typing import ArrayLike, NDArray

from ...geometry.grids import dilate
from ..terrain import noise
from ..terrain.terrain import UNKNOWN
from . import flame_noise, flame_patches, flame_phase, flame_size, flame_state
from .flame_depth import FrontFields
from .flame_view import FADE, ViewCone

_PIXELS = 2.0  # height in pixels of the typical long flames at the reach (by eye)
_LONG = 90.0  # percentile of the flame lengths of the shown fronts
_BEFORE = 900.0  # s before the first frame from which flames are still seen

_FINEST, _COARSEST = 0.25, 128.0  # m, spacing of the finest and the coarsest square
_CELLS, _TILE = 256, 8  # cells along a square, and cells along a tile of the march
_PART, _PARTS = 4.0, 4  # m, distance between the places at which lengths are averaged; most along a cell
_GROUND = 4.0  # m, distance at which the ground is computed, or more; its finest waves are 26 m long
_WIDEST = 8.0  # m, more than these shifts add up to
_OLDEST = 1200.0  # s, age at which everything is out
_MARGIN = 60.0  # m that flames may lean or rise into a picture

_MIDFLAME = 0.4  # wind at the flames over the wind above (P. L. Andrews 2012, RMRS-GTR-266, open fuel)

Array = NDArray[np.float64]


def reach(shot: Any, path: Any) -> float:
    """Return the distance (m) up to which flames are drawn as a volume for a camera.

    There the typical long flames of the shown fronts are 2 pixels high. The distance is at most
    `flame_size.SIGHT`, and 0 without flames, or in an orthographic view.

    Parameters
    ----------
    shot
        A `Shot`.
    path
        A `cameras.path.Path` of the shot.
    """
    if not path.perspective or not shot.settings.fire.flames:
        return 0.0
    return float(min(typical_length(shot) / (_PIXELS * path.pixel), flame_size.SIGHT))


def weight(distance: ArrayLike, limit: float) -> Array:
    """Return the weight 0..1 of the flame volume at a distance (m) for a `reach` (m); 0 if the reach is 0.

    Cards, glowing crowns and the ground's glowing edge have 1 minus this weight.
    """
    if limit <= 0.0:
        return np.zeros(np.shape(distance))
    return 1.0 - noise.smoothstep(FADE[0] * limit, FADE[1] * limit, distance)


def typical_length(shot: Any) -> float:
    """Return the length (m) of the shot's long flames: 90th percentile over the fronts shown; 0 if none."""
    full = shot.full
    ground, front = full.bare_ground, full.front
    first, last = full.frames.span
    shown = (ground.burned >= 0.5) & (ground.arrival <= last) & (ground.arrival >= first - _BEFORE)
    length = cell_lengths(front, full.settings.fire.flame_length)[shown]
    return float(np.percentile(length, _LONG)) if len(length) else 0.0


def cell_lengths(front: FrontFields, formula: str) -> Array:
    """Return the flame length (m) in each cell (ny, nx) of the terrain grid by a formula of `flame_size`."""
    fields = front.ground.fields
    fuel = fields.surface_fuel + fields.canopy_fuel
    intensity = constants.HEAT_OF_COMBUSTION / 1000.0 * fuel * front.speed
    return flame_size.flame_length(intensity, formula, fields.canopy_fuel > flame_size.CROWNS)


@dataclass(frozen=True)
class Square:
    """Flames on a square of the ground at one time.

    Attributes
    ----------
    length, ground
        (n, n) height of the flames, and scene z of the ground, m; rows to the north.
    corner
        Scene x and y of the first value, m.
    spacing
        Distance between values, m.
    """

    length: NDArray[np.float32]
    ground: NDArray[np.float32]
    corner: tuple[float, float]
    spacing: float


def squares(shot: Any, eye: Array, time: float, limit: float, lens: ViewCone | None = None) -> list[Square]:
    """Return the flames around a camera: nested squares, the finest first.

    Cells are about 1/128 of the distance, so the cost hardly grows with the limit. Values depend on place and
    time alone: nodes lie on multiples of the spacing in the scene, whatever the camera.

    Parameters
    ----------
    eye
        (3,) position of the camera, m.
    limit
        Distance (m) to which flames are drawn; see `reach`.
    lens
        View of the camera; flames outside of it are left out.
    """
    found, spacing, inner = [], _FINEST, None
    while True:
        square, inner = _square(shot, eye, time, spacing, inner, lens)
        found.append(square)
        if 0.5 * _CELLS * spacing > FADE[1] * limit or spacing >= _COARSEST:
            return found
        spacing *= 2.0


def patches(
    shot: Any, eye: Array, time: float, limit: float, pixel: float, lens: ViewCone | None = None
) -> flame_patches.Patches:
    """Return the flames around a camera at a time (s).

    Parameters
    ----------
    eye
        (3,) position of the camera, m.
    limit
        Distance (m) to which flames are drawn; see `reach`.
    pixel
        Size of a pixel over its distance.
    lens
        View of the camera; patches outside of it are left out.
    """
    return flame_patches.build(shot, eye, time, limit, pixel, lens, carrying_wind(shot))


def carrying_wind(shot: Any) -> tuple[float, float]:
    """Return the wind (m/s east and north) that carries the gas of flames."""
    east, north = shot.full.wind
    return _MIDFLAME * east, _MIDFLAME * north


def _burning_cells(
    shot: Any, row: Array, column: Array, every: int, spacing: float, time: float
) -> NDArray[np.bool_]:
    """Return a mask of the cells that may burn, from nodes at each `every` cells."""
    came = bilinear(shot.ground.burn_time, row.ravel(), column.ravel()).reshape(row.shape)
    far = max(1, int(np.ceil(_WIDEST / (every * spacing))))
    soonest, latest = -dilate(-came, far), dilate(np.where(came < 0.5 * UNKNOWN, came, -np.inf), far)
    active = (soonest <= time) & (latest >= time - _OLDEST)
    cells = np.arange(_CELLS + 1) // every
    return active[np.ix_(cells, cells)]


def lengths(shot: Any, place: Array, row: Array, column: Array, time: float) -> Array:
    """Return the height of flames (n,), m, at scene points (n, 2) with their row and column, at a time (s).

    Age decides: flames grow, are tall for a third of the residence time of their fuel, decline, and leave
    low residual flames in patches. Their length follows from the fireline intensity, as for `flames.Points`.
    """
    ground, front = shot.ground, shot.full.front
    row, column = flame_state.shift(shot, place, row, column)
    speed, residence = ground.spread(row, column), bilinear(front.residence, row, column)
    even = flame_state.even_length(shot, row, column, speed)
    long = np.minimum(even * flame_state.unevenness(shot, place, even), flame_state.LONGEST)
    age = time - ground.arrival_at(row, column)
    share = flame_phase.height(age, speed, residence, long, flame_state.patches(shot, place))
    found = long * flame_noise.upright(long, carrying_wind(shot)) * share
    return np.where(found >= flame_state.LEAST, found, 0.0)


def _parts(spacing: float) -> Array:
    """Return places (n, 2) in a cell, in cells to the north and east, at which lengths are averaged.

    A front is narrower than the cells at a distance, and would be a row of dots.
    """
    count = int(np.clip(np.ceil(spacing / _PART), 1, _PARTS))
    line = (np.arange(count) + 0.5) / count - 0.5
    return np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)


def _square(
    shot: Any, eye: Array, time: float, spacing: float, inner: Any, lens: ViewCone | None
) -> tuple[Square, tuple[Array, Array]]:
    """Return one square, and the corners of its inside; flames are left out within `inner` corners."""
    ground, tile = shot.ground, _TILE * spacing
    low = (np.floor(eye[:2] / tile) - _CELLS // (2 * _TILE)) * tile
    count = _CELLS + 1
    every = min(_TILE, max(2, int(_GROUND / spacing)))
    axis = np.arange(0, count, every) * spacing
    east, north = (low[0] + axis)[None, :], (low[1] + axis)[:, None]
    east, north = (values.ravel() for values in np.broadcast_arrays(east, north))
    latitude, longitude = ground.geodetic(east, north)
    rough = ground.point(latitude, longitude)[:, 2].reshape(len(axis), -1)
    row, column = (values.reshape(len(axis), -1) for values in ground.indices(latitude, longitude))
    fine = np.arange(count) / every
    up, right = (values.ravel() for values in np.meshgrid(fine, fine, indexing="ij"))
    heights = bilinear(rough, up, right).reshape(count, count)
    cells = np.arange(count) * spacing
    length = np.zeros((count, count))
    chosen = _burning_cells(shot, row, column, every, spacing, time)
    place = low + np.stack(np.meshgrid(cells, cells), axis=-1)
    if inner is not None:
        chosen &= ~np.all((place > inner[0]) & (place < inner[1]), axis=-1)
    if lens is not None and chosen.any():
        at = np.argwhere(chosen)
        points = np.concatenate([place[at[:, 0], at[:, 1]], heights[at[:, 0], at[:, 1], None]], axis=1)
        chosen[at[:, 0], at[:, 1]] = lens.sees(points - eye, _MARGIN + 2.0 * spacing)
    at = np.flatnonzero(chosen)
    if len(at):
        parts = _parts(spacing)
        total = np.zeros(len(at))
        for shift in parts:
            there, over = place.reshape(-1, 2)[at] + shift[::-1] * spacing, shift / every
            nodes = np.clip(up[at] + over[0], 0.0, None), np.clip(right[at] + over[1], 0.0, None)
            rows, columns = bilinear(row, *nodes), bilinear(column, *nodes)
            total += lengths(shot, there, rows, columns, time) ** 2
        length.ravel()[at] = np.sqrt(total / len(parts))
    inside = low + 2.0 * tile, low + (_CELLS - 2 * _TILE) * spacing
    return (
        Square(
            length.astype(np.float32), heights.astype(np.float32), (float(low[0]), float(low[1])), spacing
        ),
        inside,
    )
