"""Values at the nodes of patches of flames.

A node has the values `GROUND`, `LENGTH`, `DISTANCE`, `LOW`, `SHARE`, direction (`EAST`, `NORTH`) and `SCALE`;
see `FlameState`. Far from the camera, cells are wider than gaps, patches and the ragged
edge of the front. Values are therefore means over places in the cell of a node, about `_PART` apart:

- The share is the fraction of places that have flames when the front is there: less than 1 where it has gaps.
- Length and distance are means over these places. The front is where the distance is 0, so it is a line in
  coarse cells too, as narrow as it is, and flames lean ahead of it.
- Low flames are a mean over all places, so they are lower in coarse cells. The share is not a factor on them.

Needs no Blender.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import flame_state
from .flame_window import AHEAD, FlameWindow

SIDE = 32  # cells along a patch
GROUND, LENGTH, DISTANCE, LOW, SHARE, EAST, NORTH, SCALE = range(8)
_PART, _PARTS = 4.0, 4  # m, distance between the places of a cell; most along a cell
_GROUND, _LEAST_EVERY = 4.0, 2  # m, distance at which the ground is computed; its finest waves are 26 m long
_MOST_EVERY = 8  # cells
_AROUND = 1.5  # cells around the ground with flames that have values: interpolation needs them

Array = NDArray[np.float64]


def values(
    shot: Any, window: FlameWindow, corners: Array, spacing: float, wind: tuple[float, float]
) -> NDArray[np.float32]:
    """Return the values (n, SIDE + 1, SIDE + 1, 8) of patches with these corners (n, 2) and spacing, m."""
    ground, row, column = _mapped(shot.ground, corners, spacing)
    nodes = np.zeros((len(corners), SIDE + 1, SIDE + 1, 8), np.float32)
    nodes[..., GROUND] = ground
    near, out = window.near(row.ravel(), column.ravel(), _AROUND * spacing)
    flat = nodes.reshape(-1, 8)
    flat[:, DISTANCE] = np.where(out, flame_state.FARTHEST, -flame_state.FARTHEST)
    at = np.flatnonzero(near)
    if len(at):
        axis = np.arange(SIDE + 1) * spacing
        place = np.stack(np.broadcast_arrays(axis, axis[:, None]), axis=-1) + corners[:, None, None]
        turn = _turns(row, column, spacing)[at // (SIDE + 1) ** 2]
        place, row, column = place.reshape(-1, 2)[at], row.ravel()[at], column.ravel()[at]
        flat[at, LENGTH : SCALE + 1] = _means(shot, window, place, row, column, turn, spacing, wind)
    return nodes


def shows(nodes: NDArray[np.float32], spacing: float) -> NDArray[np.bool_]:
    """Return a mask (...) of nodes (..., 8), `spacing` metres apart, with flames over or next to them."""
    length, distance = nodes[..., LENGTH], nodes[..., DISTANCE]
    over = (distance > -AHEAD * length - 2.0 * spacing) & (distance < length + 2.0 * spacing)
    return (length > 0.0) & (over | (nodes[..., LOW] > 0.0))


def _mapped(ground: Any, corners: Array, spacing: float) -> tuple[Array, Array, Array]:
    """Return scene z (m), row and column of the terrain at nodes, all (n, SIDE + 1, SIDE + 1)."""
    every = int(np.clip(_GROUND / spacing, _LEAST_EVERY, _MOST_EVERY))
    axis = np.arange(0, SIDE + 1, every) * spacing
    shape = len(corners), len(axis), len(axis)
    east = np.broadcast_to((corners[:, :1] + axis)[:, None, :], shape)
    north = np.broadcast_to((corners[:, 1:] + axis)[:, :, None], shape)
    latitude, longitude = ground.geodetic(east.ravel(), north.ravel())
    height = ground.point(latitude, longitude)[:, 2]
    row, column = ground.indices(latitude, longitude)
    fine = np.arange(SIDE + 1) / every
    low = np.minimum(fine.astype(int), len(axis) - 2)
    weights = np.zeros((SIDE + 1, len(axis)))
    weights[np.arange(SIDE + 1), low], weights[np.arange(SIDE + 1), low + 1] = 1.0 - fine + low, fine - low
    up, along, across = (weights @ each.reshape(shape) @ weights.T for each in (height, row, column))
    return up, along, across


def _turns(row: Array, column: Array, spacing: float) -> Array:
    """Return the derivatives (n, 2, 2) of row and column to the north and east, 1/m."""
    width = SIDE * spacing
    return np.stack(
        [
            np.stack([each[:, -1, 0] - each[:, 0, 0], each[:, 0, -1] - each[:, 0, 0]], axis=-1) / width
            for each in (row, column)
        ],
        axis=1,
    )


def _means(
    shot: Any,
    window: FlameWindow,
    place: Array,
    row: Array,
    column: Array,
    turn: Array,
    spacing: float,
    wind: tuple[float, float],
) -> Array:
    """Return length, distance, low flames, share, direction and scale (n, 7)."""
    parts = int(np.clip(np.ceil(spacing / _PART), 1, _PARTS))
    if parts == 1:
        state = flame_state.at(shot, place, row, column, window.time, wind)
        burns = (state.length > 0.0).astype(np.float64)
        return np.column_stack([state.length, state.distance, state.low, burns, state.direction, state.scale])
    line = ((np.arange(parts) + 0.5) / parts - 0.5) * spacing
    north, east = (each.ravel() for each in np.meshgrid(line, line, indexing="ij"))
    places = place[:, None] + np.stack([east, north], axis=-1)
    rows, columns = (
        each[:, None] + turn[:, axis, :1] * north + turn[:, axis, 1:] * east
        for axis, each in enumerate((row, column))
    )
    state = flame_state.at(shot, places.reshape(-1, 2), rows.ravel(), columns.ravel(), window.time, wind)
    parts_of = [each.reshape(rows.shape) for each in (state.length, state.distance, state.low)]
    direction = state.direction.reshape(*rows.shape, 2).sum(axis=1)
    direction /= np.maximum(np.hypot(*direction.T), 1.0e-9)[:, None]
    return np.column_stack([_mean(*parts_of), direction, state.scale.reshape(rows.shape).mean(axis=1)])


def _mean(length: Array, distance: Array, low: Array) -> Array:
    """Return length, distance, low flames and share (n, 4) of cells, from their places (n, k)."""
    can = length > 0.0
    count = np.maximum(can.sum(axis=1), 1)
    long, away = ((can * each).sum(axis=1) / count for each in (length, distance))
    away = np.where(can.any(axis=1), away, distance.mean(axis=1))
    return np.stack([long, away, low.mean(axis=1), can.mean(axis=1)], axis=-1)
